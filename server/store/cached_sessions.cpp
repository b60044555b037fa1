#include "store/cached_sessions.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <tuple>

#include "slicing/object.hpp"

namespace oval4d::store {

void PendingChanges::addOlder(PendingChanges older) {
    if (!head) head = std::move(older.head);
    if (!whole) whole = std::move(older.whole);
    std::ranges::move(older.waiting, std::back_inserter(waiting));
}

void CachedSessions::addStored(const SessionCredentials& credentials, FencingToken fence) {
    CachedSession& cached = sessions_[credentials.id];
    cached.credentials = credentials;
    cached.fence = fence;
    cached.everSaved = true;
}

CachedSession* CachedSessions::find(const std::string& id) {
    const auto found = sessions_.find(id);
    return found == sessions_.end() ? nullptr : &found->second;
}

const CachedSession* CachedSessions::find(const std::string& id) const {
    const auto found = sessions_.find(id);
    return found == sessions_.end() ? nullptr : &found->second;
}

std::optional<CachedSession> CachedSessions::remove(const std::string& id) {
    auto node = sessions_.extract(id);
    if (node.empty()) return {};
    return std::move(node.mapped());
}

std::vector<std::string> CachedSessions::removeClosedBefore(CachedSession::Clock::time_point time) {
    std::vector<std::string> removed;
    std::erase_if(sessions_, [&](const auto& entry) {
        const bool old = entry.second.closed && entry.second.closedAt < time;
        if (old) removed.push_back(entry.first);
        return old;
    });
    return removed;
}

std::vector<std::pair<std::string, CachedSession>> CachedSessions::evictClosed(std::size_t quota) {
    std::size_t bytes = 0;
    std::vector<decltype(sessions_)::iterator> closed;
    for (auto entry = sessions_.begin(); entry != sessions_.end(); ++entry) {
        const CachedSession& cached = entry->second;
        if (!cached.closed || cached.inFlight) continue;
        bytes += cached.bytes;
        closed.push_back(entry);
    }
    std::vector<std::pair<std::string, CachedSession>> evicted;
    if (bytes <= quota) return evicted;
    std::ranges::sort(closed, {}, [quota](const auto& entry) {
        const CachedSession& cached = entry->second;
        return std::tuple(cached.bytes <= quota, cached.pending.whole->revision > 0, cached.closedAt);
    });
    for (const auto& entry : closed) {
        if (bytes <= quota) break;
        bytes -= entry->second.bytes;
        evicted.emplace_back(entry->first, std::move(entry->second));
        sessions_.erase(entry);
    }
    std::erase_if(queue_, [this](const std::string& id) { return !sessions_.contains(id); });
    return evicted;
}

void CachedSessions::enqueue(const std::string& id, CachedSession& cached) {
    if (std::exchange(cached.queued, true)) return;
    queue_.push_back(id);
}

std::optional<std::string> CachedSessions::takeFirstQueued() {
    while (!queue_.empty()) {
        std::string id = std::move(queue_.front());
        queue_.pop_front();
        CachedSession* const cached = find(id);
        // Skip a session that was removed after it was queued. `queued` is false if the session was added again without
        // changes to write.
        if (cached == nullptr || !cached->queued) continue;
        cached->queued = false;
        cached->inFlight = true;
        return id;
    }
    return {};
}

std::size_t CachedSessions::neverSavedCount() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(sessions_, [](const auto& entry) { return !entry.second.everSaved; }));
}

std::size_t CachedSessions::unsaved() const {
    return static_cast<std::size_t>(std::ranges::count_if(sessions_, [](const auto& entry) {
        const CachedSession& cached = entry.second;
        return cached.changed || cached.pending.head || cached.pending.whole || cached.inFlight;
    }));
}

std::vector<std::string> CachedSessions::idsOfOpenSavedSessions() const {
    std::vector<std::string> ids;
    for (const auto& [id, cached] : sessions_) {
        if (cached.everSaved && !cached.closed) ids.push_back(id);
    }
    return ids;
}

std::size_t estimateMemory(const session::Session& session) {
    std::map<const void*, const slicing::Object*> objects;
    std::size_t bytes = sizeof session;
    const auto addObject = [&](const slicing::Object& object) {
        objects.try_emplace(slicing::identityOf(object), &object);
    };
    const auto add = [&](const session::State& state) {
        for (const slicing::Object* object : state.sourceAndObject()) addObject(*object);
        bytes += sizeof state +
                 (state.look.cellTypes.hidden.size() + state.look.cellTypes.faded.size()) * sizeof(std::uint32_t);
    };
    for (const slicing::Object* object : session.current.sourceAndObject()) addObject(*object);
    for (const session::State& state : session.undoSteps) add(state);
    for (const session::State& state : session.redoSteps) add(state);
    for (const auto& [name, object] : session.loaded) addObject(object);
    for (const auto& [identity, object] : objects) bytes += slicing::memoryOf(*object);
    return bytes;
}

}  // namespace oval4d::store
