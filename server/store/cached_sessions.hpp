#pragma once
// The sessions in the memory of a write-behind store, and the queue of those with changes to be written.

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

/// A callback for the end of a save: `true` when the changes are stored, `false` if they will not be.
using Written = std::function<void(bool)>;

/// Changes of a session that are not yet in the store. `head` and `whole` are the sessions whose current state, or
/// which as a whole, are to be written; null if they are not.
struct PendingChanges {
    std::shared_ptr<const session::Session> head, whole;
    std::vector<Written> waiting;  ///< callbacks to call when these changes are written

    /// Adds older changes. Where both have a value, the newer one stays.
    void addOlder(PendingChanges older);
};

/// A session in memory.
struct CachedSession {
    using Clock = std::chrono::steady_clock;

    SessionCredentials credentials;
    Fence fence = 1;
    PendingChanges pending;
    bool saved = false;          ///< whether the session has ever been in the store
    bool queued = false;         ///< whether the session is in the queue
    bool inFlight = false;       ///< whether the session is being written
    bool closed = false;         ///< whether no client has the session open; it is dropped once it is written
    Clock::time_point closedAt;  ///< the time at which it was closed, if `closed`
    std::size_t bytes = 0;       ///< estimated memory of the session, if `closed`
};

/// The sessions in memory. Not thread-safe.
class CachedSessions {
  public:
    /// Adds a session that has never been in the store.
    void add(const SessionCredentials& credentials) { sessions_[credentials.id].credentials = credentials; }
    /// Adds a session that another server, or this one, has stored.
    void addStored(const SessionCredentials& credentials, Fence fence);

    bool contains(const std::string& id) const { return sessions_.contains(id); }
    /// Returns the session; null if it is not in memory.
    CachedSession* find(const std::string& id);
    /// Removes a session, and returns it, so that the caller can destroy it without holding a lock; nothing if it is
    /// not in memory.
    std::optional<CachedSession> remove(const std::string& id);
    /// Removes the closed sessions that were closed before `time`, and returns their ids.
    std::vector<std::string> removeClosedBefore(CachedSession::Clock::time_point time);
    /// Removes closed sessions until the remaining ones have at most `quota` bytes, and returns the removed ones with
    /// their ids. Removes sessions that were never changed first, then those that were closed first. Skips sessions
    /// that are being written.
    std::vector<std::pair<std::string, CachedSession>> evictClosed(std::size_t quota);

    /// Appends a session to the queue, unless it is in it.
    void enqueue(const std::string& id, CachedSession& cached);
    /// Takes the first session from the queue, marks it as being written, and returns its id; nothing if the queue is
    /// empty.
    std::optional<std::string> takeQueued();
    /// Returns the length of the queue.
    std::size_t queueLength() const { return queue_.size(); }

    std::size_t size() const { return sessions_.size(); }
    /// Returns the number of sessions that have never been in the store.
    std::size_t neverSaved() const;
    /// Returns the number of sessions with changes that are not known to be in the store.
    std::size_t unsaved() const;
    /// Returns the ids of the sessions that clients have open and the store has.
    std::vector<std::string> openAndSaved() const;

  private:
    std::map<std::string, CachedSession, std::less<>> sessions_;
    std::deque<std::string> queue_;
};

/// Returns an estimate of a session's memory in bytes, including objects that it shares with other sessions.
std::size_t estimateMemory(const session::Session& session);

}  // namespace oval4d::store
