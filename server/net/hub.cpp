#include "net/hub.hpp"

#include <spdlog/spdlog.h>

namespace oval4d::net {

Hub::Joined Hub::create() {
    const std::lock_guard lock(mutex_);
    const auto ticket = store_->create();
    if (!ticket) return ticket.error();
    spdlog::info("session created session={}", ticket->id);
    return bringToLife(*ticket, session::Session{});
}

Hub::Joined Hub::join(const store::Ticket& ticket) {
    const std::lock_guard lock(mutex_);
    if (const auto admitted = store_->admit(ticket); !admitted) return admitted.error();
    if (const auto found = live_.find(ticket.id); found != live_.end()) {
        ++found->second.clients;
        return found->second.session;
    }
    auto value = store_->open(ticket.id);
    if (!value) return value.error();
    spdlog::info("session opened session={}", ticket.id);
    return bringToLife(ticket, std::move(*value));
}

std::shared_ptr<LiveSession> Hub::bringToLife(store::Ticket ticket, session::Session value) {
    const std::string id = ticket.id;
    auto session = std::make_shared<LiveSession>(services_, std::move(ticket), std::move(value));
    live_.emplace(id, Live{session, 1});
    countSessions();
    return session;
}

void Hub::leave(const std::shared_ptr<LiveSession>& session, std::shared_ptr<Peer> peer) {
    const std::string id = session->ticket().id;
    session->leave(std::move(peer), [self = shared_from_this(), id](const session::Session& value) {
        const std::lock_guard lock(self->mutex_);
        const auto found = self->live_.find(id);
        if (found == self->live_.end() || --found->second.clients > 0) return;
        self->store_->close(id, value, std::chrono::system_clock::now());
        self->live_.erase(found);
        self->countSessions();
        spdlog::info("session closed session={}", id);
    });
}

void Hub::tidy(Seconds age) {
    const auto limit =
        std::chrono::system_clock::now() - std::chrono::duration_cast<std::chrono::system_clock::duration>(age);
    if (const std::size_t gone = store_->expire(limit); gone > 0) spdlog::info("sessions expired count={}", gone);
    const std::lock_guard lock(mutex_);
    countSessions();
}

void Hub::countSessions() {
    services_.metrics.sessions.Set(static_cast<double>(store_->size()));
    services_.metrics.openSessions.Set(static_cast<double>(live_.size()));
}

}  // namespace oval4d::net
