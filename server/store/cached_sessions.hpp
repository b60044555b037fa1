#pragma once
// The sessions in the memory of WriteBehindStore, a cache before the session store, and the queue of sessions whose
// changes must be written to the store.

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

/// A callback that is called once for changes to save. Its argument is `true` if the changes are in the store, or wait
/// in memory because the store is unavailable. The argument is `false` if the changes will never be stored.
using SaveCallback = std::function<void(bool)>;

/// The changes of a session that are not in the store yet. `head` is the session if its current state must be written,
/// else null. `whole` is the session if all of it must be written, else null.
struct PendingChanges {
    std::shared_ptr<const session::Session> head, whole;
    std::vector<SaveCallback> waiting;  ///< the callbacks for these changes that have not been called yet

    /// Adds older changes. Takes `head` and `whole` from `older` only where they are null here, and appends the
    /// callbacks of `older`.
    void addOlder(PendingChanges older);
};

/// What a write-behind store knows of a session in memory: its credentials, its changes that are not in the store yet,
/// and whether it is queued, being written or closed.
struct CachedSession {
    using Clock = std::chrono::steady_clock;

    SessionCredentials credentials;
    FencingToken fence = kFirstFence;
    PendingChanges pending;
    bool changed = false;        ///< whether the session has changed since the last save()
    bool everSaved = false;      ///< whether the session has ever been in the store
    bool queued = false;         ///< whether the session waits in the queue of sessions to write
    bool inFlight = false;       ///< whether the session is being written
    bool closed = false;         ///< whether no client has the session open; a closed session is removed from memory
                                 ///< once it is written
    Clock::time_point closedAt;  ///< when the session was closed; valid only if `closed`
    std::size_t bytes = 0;       ///< estimated memory of the session in bytes; valid only if `closed`
};

/// The sessions in memory, by id, and the queue of sessions to write. Not thread-safe.
class CachedSessions {
  public:
    /// Adds a session that has never been in the store.
    void addNew(const SessionCredentials& credentials) { sessions_[credentials.id].credentials = credentials; }
    /// Adds a session that is in the store. This server has claimed the session (become its owner) with this fence (the
    /// number of the claim).
    void addStored(const SessionCredentials& credentials, FencingToken fence);

    bool contains(const std::string& id) const { return sessions_.contains(id); }
    /// Returns the session with this id, or a null pointer if the session is not in memory.
    CachedSession* find(const std::string& id);
    const CachedSession* find(const std::string& id) const;
    /// Removes a session from memory and returns it, so that the caller can destroy it without holding a lock. Returns
    /// an empty optional if the session is not in memory.
    std::optional<CachedSession> remove(const std::string& id);
    /// Removes the closed sessions that were closed before `time`. Returns their ids.
    std::vector<std::string> removeClosedBefore(CachedSession::Clock::time_point time);
    /// Removes closed sessions until the remaining closed sessions take at most `quota` bytes. Returns the removed
    /// sessions with their ids. Removes sessions in this order: first those that alone take more than `quota`, then
    /// those that were never changed, then all others; within each group, first those that were closed earlier. Neither
    /// removes nor counts sessions that are being written.
    std::vector<std::pair<std::string, CachedSession>> evictClosed(std::size_t quota);

    /// Appends a session to the queue, unless the session is already queued.
    void enqueue(const std::string& id, CachedSession& cached);
    /// Takes the first session from the queue, marks the session as being written, and returns its id. Returns an empty
    /// optional if the queue is empty.
    std::optional<std::string> takeFirstQueued();
    /// Returns the length of the queue, in which sessions that were removed from memory may still stand.
    std::size_t queueLength() const { return queue_.size(); }

    std::size_t size() const { return sessions_.size(); }
    /// Returns the number of sessions that have never been in the store.
    std::size_t neverSavedCount() const;
    /// Returns the number of sessions with changes that may not be in the store yet.
    std::size_t unsaved() const;
    /// Returns the ids of the sessions that a client has open and that have ever been in the store.
    std::vector<std::string> idsOfOpenSavedSessions() const;

  private:
    std::map<std::string, CachedSession, std::less<>> sessions_;
    std::deque<std::string> queue_;
};

/// Returns an estimate of the memory of a session with its objects, in bytes. Counts objects even if other sessions
/// share them.
std::size_t estimateMemory(const session::Session& session);

}  // namespace oval4d::store
