#pragma once
// The sessions in the memory of a write-behind store, and the queue of the sessions that have changes to write.

#include <chrono>
#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "session/session.hpp"
#include "store/store.hpp"

namespace oval4d::store {

/// A callback that is called when changes have been saved. Its argument is `true` if the changes are stored, or if they
/// wait in memory because the store is unavailable; `false` if the changes will never be stored.
using SaveCallback = std::function<void(bool)>;

/// Changes of a session that are not yet in the store. `head`: the session if its current state must be written, else
/// null. `whole`: the session if it must be written as a whole, else null.
struct PendingChanges {
    std::shared_ptr<const session::Session> head, whole;
    std::vector<SaveCallback> waiting;  ///< callbacks to call when these changes are written

    /// Adds older changes: takes `head` and `whole` from `older` only where this object has none, and adds the
    /// callbacks of `older`.
    void addOlder(PendingChanges older);
};

/// What a write-behind store knows of a session in memory: its credentials, its changes that are not yet in the store,
/// and whether it is queued, being written or closed.
struct CachedSession {
    using Clock = std::chrono::steady_clock;

    SessionCredentials credentials;
    Fence fence = kFirstFence;
    PendingChanges pending;
    bool changed = false;        ///< whether the session has changed since the last WriteBehindStore::save()
    bool everSaved = false;      ///< whether the session has ever been in the store
    bool queued = false;         ///< whether the session is in the queue of CachedSessions
    bool inFlight = false;       ///< whether the session is being written
    bool closed = false;         ///< whether no client has the session open; a closed session is dropped once written
    Clock::time_point closedAt;  ///< the time at which the session was closed, if `closed`
    std::size_t bytes = 0;       ///< estimated memory of the session in bytes, if `closed`
};

/// The sessions in memory, by id, and the queue of the sessions to write. Not thread-safe.
class CachedSessions {
  public:
    /// Adds a session that has never been in the store.
    void add(const SessionCredentials& credentials) { sessions_[credentials.id].credentials = credentials; }
    /// Adds a session that is in the store, and that this server has claimed with this fence.
    void addStored(const SessionCredentials& credentials, Fence fence);

    bool contains(const std::string& id) const { return sessions_.contains(id); }
    /// Returns the session with this id; a null pointer if it is not in memory.
    CachedSession* find(const std::string& id);
    const CachedSession* find(const std::string& id) const;
    /// Removes a session and returns it; an empty optional if it is not in memory. The caller can then destroy the
    /// session without holding a lock.
    std::optional<CachedSession> remove(const std::string& id);
    /// Removes the closed sessions that were closed before `time`, and returns their ids.
    std::vector<std::string> removeClosedBefore(CachedSession::Clock::time_point time);
    /// Removes closed sessions until the remaining closed ones take at most `quota` bytes, and returns the removed ones
    /// with their ids. Removes first the sessions that take more than `quota` alone, then those that were never
    /// changed, then the others; of each kind, first those that were closed first. Neither removes nor counts sessions
    /// that are being written.
    std::vector<std::pair<std::string, CachedSession>> evictClosed(std::size_t quota);

    /// Appends a session to the queue unless it is already queued.
    void enqueue(const std::string& id, CachedSession& cached);
    /// Takes the first session from the queue, marks it as being written, and returns its id; an empty optional if the
    /// queue is empty.
    std::optional<std::string> takeQueued();
    /// Returns the length of the queue.
    std::size_t queueLength() const { return queue_.size(); }

    std::size_t size() const { return sessions_.size(); }
    /// Returns the number of sessions that have never been in the store.
    std::size_t neverSaved() const;
    /// Returns the number of sessions with changes that are not known to be in the store.
    std::size_t unsaved() const;
    /// Returns the ids of the sessions that clients have open and that have been in the store.
    std::vector<std::string> openAndEverSaved() const;

  private:
    std::map<std::string, CachedSession, std::less<>> sessions_;
    std::deque<std::string> queue_;
};

/// Returns an estimate of a session's memory in bytes, including objects that it shares with other sessions.
std::size_t estimateMemory(const session::Session& session);

}  // namespace oval4d::store
