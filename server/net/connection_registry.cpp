#include "net/connection_registry.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace oval4d::net {

ConnectionRegistry::Registration::Registration(ConnectionRegistry& connections, ClientAccountPtr client)
    : connections_(connections) {
    const std::lock_guard lock(connections_.mutex_);
    number_ = ++connections_.last_;
    ++connections_.counts_[client.get()];
    connections_.entries_.emplace(number_, RegisteredConnection{std::move(client), nullptr});
}

ConnectionRegistry::Registration::~Registration() {
    RegisteredConnection gone;  // destroyed after the lock is released, because it may own the connection
    const std::lock_guard lock(connections_.mutex_);
    const auto found = connections_.entries_.find(number_);
    if (found == connections_.entries_.end()) return;  // the connection was evicted
    gone = std::move(found->second);
    connections_.entries_.erase(found);
    connections_.decrementCount(gone.client.get());
}

void ConnectionRegistry::Registration::setEndHandler(EndHandler handler) {
    bool now = false;
    EndReason reason = EndReason::stopping;
    {
        const std::lock_guard lock(connections_.mutex_);
        const auto found = connections_.entries_.find(number_);
        const bool evicted = found == connections_.entries_.end();
        if (evicted) reason = EndReason::evicted;
        now = connections_.stopping_ || evicted;
        if (!evicted) {
            std::swap(found->second.end, handler);
            if (now) handler = found->second.end;
        }
    }
    if (now && handler) handler(reason);
}

void ConnectionRegistry::Registration::setInUse(bool inUse) {
    const std::lock_guard lock(connections_.mutex_);
    const auto found = connections_.entries_.find(number_);
    if (found != connections_.entries_.end()) found->second.inUse = inUse;
}

void ConnectionRegistry::Registration::setClient(const ClientAccountPtr& client) {
    ClientAccountPtr before;
    const std::lock_guard lock(connections_.mutex_);
    const auto found = connections_.entries_.find(number_);
    if (found == connections_.entries_.end()) return;
    before = std::exchange(found->second.client, client);
    connections_.decrementCount(before.get());
    ++connections_.counts_[client.get()];
}

void ConnectionRegistry::decrementCount(const ClientAccount* client) {
    const auto count = counts_.find(client);
    if (--count->second == 0) counts_.erase(count);
}

std::size_t ConnectionRegistry::connectionCountOf(const ClientAccount* client) const {
    const auto count = counts_.find(client);
    return count == counts_.end() ? 0 : count->second;
}

/// Removes the oldest idle connection of this client from the registry. Returns the handler that ends the connection.
/// Returns an empty function if the client has no idle connection with a handler.
ConnectionRegistry::EndHandler ConnectionRegistry::evictIdle(const ClientAccount* client) {
    const auto idle = std::ranges::find_if(entries_, [client](const auto& entry) {
        return entry.second.client.get() == client && !entry.second.inUse && entry.second.end;
    });
    if (idle == entries_.end()) return {};
    EndHandler end = std::move(idle->second.end);
    entries_.erase(idle);
    decrementCount(client);
    return end;
}

ConnectionRegistry::AdmissionDecision ConnectionRegistry::makeRoomFor(const ClientAccount& client,
                                                                      std::size_t registered, bool isProxy) {
    AdmissionDecision admission = AdmissionDecision::admitted;
    std::vector<EndHandler> ends;
    const auto evict = [&](const ClientAccount* from, AdmissionDecision otherwise) {
        if (EndHandler end = evictIdle(from)) {
            ends.push_back(std::move(end));
        } else {
            admission = otherwise;
        }
    };
    {
        const std::lock_guard lock(mutex_);
        // Refused connections stay registered until they end. The number of connections may therefore exceed a limit by
        // more than one, and several idle connections may have to be evicted.
        while (admission == AdmissionDecision::admitted) {
            if (!isProxy && connectionCountOf(&client) - registered >= maxPerClient_) {
                evict(&client, AdmissionDecision::client_full);
            } else if (entries_.size() - registered >= maxConnections_) {
                const auto most = std::ranges::max_element(counts_, {}, &decltype(counts_)::value_type::second);
                evict(most->first, AdmissionDecision::server_full);
            } else {
                break;
            }
        }
    }
    for (const EndHandler& end : ends) end(EndReason::evicted);
    return admission;
}

std::size_t ConnectionRegistry::size() const {
    const std::lock_guard lock(mutex_);
    return entries_.size();
}

void ConnectionRegistry::stopAll() {
    // The handlers are called without the lock, because a connection may end immediately and then destroys its
    // registration.
    std::vector<EndHandler> ends;
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
        for (const auto& [number, entry] : entries_) {
            if (entry.end) ends.push_back(entry.end);
        }
    }
    for (const auto& end : ends) end(EndReason::stopping);
}

}  // namespace oval4d::net
