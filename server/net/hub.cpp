#include "net/hub.hpp"

#include <spdlog/spdlog.h>

#include "store/codec.hpp"
#include "store/secret.hpp"

namespace oval4d::net {

using protocol::Error;
using protocol::ErrorCode;
using store::Keeper;

namespace {

store::Keeper::Settings settingsFrom(const Options& options) {
    return {std::chrono::duration_cast<store::Milliseconds>(options.sessionExpiry), options.keptUndo};
}

/// What `decode` needs of a record, and the keys of the polytopes that it has given out.
class KeptPolytopes {
  public:
    explicit KeptPolytopes(const store::Record& record) {
        for (const auto& [key, bytes] : record.polytopes) bytes_[key] = bytes;
    }
    session::PolytopePtr operator()(const std::string& key) {
        auto& polytope = built_[key];
        if (!polytope && bytes_.contains(key)) polytope = store::decodePolytope(bytes_[key]);
        return polytope;
    }
    Keeper::Keys keys() const {
        Keeper::Keys keys;
        for (const auto& [key, polytope] : built_) {
            if (polytope) keys[polytope->serial] = key;
        }
        return keys;
    }

  private:
    std::map<std::string, std::string_view> bytes_;
    std::map<std::string, session::PolytopePtr> built_;
};

}  // namespace

Hub::Hub(Services services, std::unique_ptr<store::Store> store)
    : services_(services), keeper_(std::move(store), settingsFrom(services.options), listener()) {}

Keeper::Listener Hub::listener() {
    return {[this](const std::string& id) { dismiss(id); },
            [this](const std::string& id) {
                if (const auto session = find(id)) session->save();
            },
            [this] { saveAll(); },
            [this](const char* what, double seconds, bool worked) {
                services_.metrics.observeStore(what, seconds, worked);
            }};
}

void Hub::create(const Done& done) {
    std::unique_lock lock(mutex_);
    if (keeper_.count() >= services_.options.maxSessions) {
        lock.unlock();
        done(Error{ErrorCode::too_many, "the server keeps at most " + std::to_string(services_.options.maxSessions) +
                                            " sessions, and all are taken; try again later"});
        return;
    }
    const store::Ticket ticket = keeper_.create();
    const auto session = bringToLife(ticket, session::Session{});
    lock.unlock();
    spdlog::info("session created session={}", ticket.id);
    if (keeper_.pace() == store::Store::Pace::at_once) {
        // Whoever is welcome must find it on every server.
        keeper_.save(ticket.id, session::Session{}, Keeper::Part::whole, [done, session](bool) { done(session); });
    } else {
        if (keeper_.pace() == store::Store::Pace::soon) session->save();
        done(session);
    }
}

void Hub::join(const store::Ticket& ticket, const Done& done) {
    std::unique_lock lock(mutex_);
    if (const auto found = live_.find(ticket.id); found != live_.end()) {
        Live& live = found->second;
        const auto session = live.session;
        const bool admitted = store::sameSecret(ticket.token, session->ticket().token);
        if (admitted) ++live.clients;
        lock.unlock();
        done(admitted ? Joined(session) : Error{ErrorCode::bad_token, "this token does not open the session"});
        return;
    }
    const auto [opening, isFirst] = opening_.try_emplace(ticket.id);
    if (!isFirst) {
        opening->second.push_back({ticket, done});
        return;
    }
    lock.unlock();
    keeper_.fetch(ticket, [self = shared_from_this(), ticket, done](Keeper::Fetch fetch) {
        self->fetched(ticket, done, std::move(fetch));
    });
}

/// On the keeper's thread: what takes long is for a worker.
void Hub::fetched(const store::Ticket& ticket, const Done& done, Keeper::Fetch fetch) {
    if (!fetch) {
        opened(ticket, done, fetch.error());
    } else if (fetch->session) {
        opened(ticket, done, std::move(*fetch->session));
    } else {
        services_.pool.post([self = shared_from_this(), ticket, done, record = std::move(fetch->record)](
                                picture::Painter& /*unused*/) { self->read(ticket, done, record); });
    }
}

void Hub::read(const store::Ticket& ticket, const Done& done, const store::Record& record) {
    try {
        KeptPolytopes polytopes(record);
        auto value = store::decode(record.whole, record.head, std::ref(polytopes));
        keeper_.know(ticket.id, polytopes.keys());
        opened(ticket, done, std::move(value));
    } catch (const std::exception& fault) {
        spdlog::error("session cannot be read session={} store={} fault=\"{}\"", ticket.id, keeper_.name(),
                      fault.what());
        keeper_.letGo(ticket.id);
        opened(ticket, done,
               Error{ErrorCode::not_found,
                     "this session was kept in a form that the server cannot read: " + std::string(fault.what())});
    }
}

/// Answers who asked first, and lets the others ask again.
void Hub::opened(const store::Ticket& ticket, const Done& done, protocol::Result<session::Session> value) {
    std::vector<Waiting> others;
    std::shared_ptr<LiveSession> session;
    {
        const std::lock_guard lock(mutex_);
        others = std::move(opening_[ticket.id]);
        opening_.erase(ticket.id);
        if (value) session = bringToLife(ticket, std::move(*value));
    }
    if (session) spdlog::info("session opened session={}", ticket.id);
    done(session ? Joined(session) : value.error());
    for (const auto& [wanted, waiting] : others) join(wanted, waiting);
}

std::shared_ptr<LiveSession> Hub::bringToLife(store::Ticket ticket, session::Session value) {
    const std::string id = ticket.id;
    auto session = std::make_shared<LiveSession>(services_, keeper_, std::move(ticket), std::move(value));
    live_.emplace(id, Live{session, 1});
    return session;
}

void Hub::leave(const std::shared_ptr<LiveSession>& session, std::shared_ptr<Peer> peer) {
    session->leave(std::move(peer), [self = shared_from_this(), session](const session::Session& value) {
        const std::string& id = session->ticket().id;
        const std::lock_guard lock(self->mutex_);
        const auto found = self->live_.find(id);
        if (found == self->live_.end() || found->second.session != session || --found->second.clients > 0) return false;
        self->keeper_.close(id, value);
        self->live_.erase(found);
        spdlog::info("session closed session={}", id);
        return true;
    });
}

/// Another server goes on with this session: so its clients are to go there.
void Hub::dismiss(const std::string& id) {
    std::shared_ptr<LiveSession> session;
    {
        const std::lock_guard lock(mutex_);
        const auto found = live_.find(id);
        if (found == live_.end()) return;
        session = std::move(found->second.session);
        live_.erase(found);
    }
    services_.metrics.sessionsTaken.Increment();
    spdlog::info("session taken over by another server session={}", id);
    session->dismiss();
}

std::shared_ptr<LiveSession> Hub::find(const std::string& id) const {
    const std::lock_guard lock(mutex_);
    const auto found = live_.find(id);
    return found == live_.end() ? nullptr : found->second.session;
}

void Hub::saveAll(const std::shared_ptr<void>& until) {
    if (keeper_.pace() == store::Store::Pace::at_close) return;
    const std::lock_guard lock(mutex_);
    for (const auto& [id, live] : live_) live.session->save(until);
}

void Hub::stop(Seconds limit) { keeper_.stop(std::chrono::duration_cast<store::Milliseconds>(limit)); }

std::size_t Hub::open() const {
    const std::lock_guard lock(mutex_);
    return live_.size();
}

}  // namespace oval4d::net
