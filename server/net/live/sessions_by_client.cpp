#include "net/live/sessions_by_client.hpp"

namespace oval4d::net {

void SessionsByClient::recordOpened(const std::string& id, const std::string& client) {
    const auto [found, isNew] = sessions_.try_emplace(id);
    if (isNew) {
        found->second.client = client;
        ++clients_[client].sessions;
    } else {
        reopen(found->second);
    }
}

void SessionsByClient::recordClosed(const std::string& id, bool unmodified, Clock::time_point now) {
    const auto found = sessions_.find(id);
    if (found == sessions_.end()) return;
    RecordedSession& session = found->second;
    session.closed = ++last_;
    session.unmodified = unmodified;
    session.expires = now + expiry_;
    closed_.emplace(session.closed, id);
    if (!unmodified) return;
    unmodified_.emplace(session.closed, id);
    clients_[session.client].unmodified.emplace(session.closed, id);
}

void SessionsByClient::reopen(RecordedSession& session) {
    closed_.erase(session.closed);
    unmodified_.erase(session.closed);
    clients_[session.client].unmodified.erase(session.closed);
    session.closed = 0;
}

void SessionsByClient::remove(const std::string& id) {
    if (const auto found = sessions_.find(id); found != sessions_.end()) erase(found);
}

void SessionsByClient::erase(SessionsById::iterator session) {
    reopen(session->second);
    const auto owner = clients_.find(session->second.client);
    if (--owner->second.sessions == 0) clients_.erase(owner);
    sessions_.erase(session);
}

void SessionsByClient::expire(Clock::time_point now) {
    while (!closed_.empty()) {
        const auto first = sessions_.find(closed_.begin()->second);
        if (first->second.expires > now) return;
        erase(first);
    }
}

std::size_t SessionsByClient::countSessionsOf(const std::string& client, Clock::time_point now) {
    expire(now);
    const auto owner = clients_.find(client);
    return owner == clients_.end() ? 0 : owner->second.sessions;
}

std::optional<std::string> SessionsByClient::firstClosedUnmodified(Clock::time_point now, const std::string* client) {
    expire(now);
    const auto* sessions = &unmodified_;
    if (client != nullptr) {
        const auto owner = clients_.find(*client);
        if (owner == clients_.end()) return std::nullopt;
        sessions = &owner->second.unmodified;
    }
    return sessions->empty() ? std::nullopt : std::optional(sessions->begin()->second);
}

}  // namespace oval4d::net
