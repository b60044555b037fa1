#pragma once
// A write-behind cache of sessions. Only a thread of the cache uses the session store, so that no other thread waits
// for a disk or a network.

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <thread>

#include "errors/error.hpp"
#include "session/session.hpp"
#include "store/backoff.hpp"
#include "store/cached_sessions.hpp"
#include "store/store.hpp"
#include "store/stored_object_keys.hpp"

namespace oval4d::store {

/// A write-behind cache before a Store: it keeps changes of sessions in memory and writes them to the store later. The
/// cache holds the sessions that clients have open on this server, and closed sessions whose last change is not in the
/// store yet. Only the store thread, which this object starts, uses the store. If several changes of a session are
/// pending, only the newest version of the session is written.
///
/// The store counts as unavailable from a failed operation until the next successful one. During this time, changes
/// wait in memory, no caller waits for the store, and the cache retries with growing pauses (exponential backoff). If
/// the store is full, closed sessions are evicted from the store. If the store is unavailable and closed sessions in
/// memory take more than `WriteBehindSettings::quota`, some of them are evicted from memory. Open sessions are never
/// evicted.
///
/// Thread-safe. Callbacks must return quickly: they run on the store thread, or on the thread that calls a function of
/// this class.
class WriteBehindStore {
  public:
    struct WriteBehindSettings {
        Milliseconds expiry{1'800'000};  ///< the time after which a session that no client has open is deleted
        std::size_t maxUndo = 100;       ///< maximum number of undo steps, and of redo steps, that are stored with a
                                         ///< session
        /// The maximum estimated memory, in bytes, of closed sessions that wait while the store is unavailable.
        std::size_t quota = kDefaultQuota;
    };
    /// The callbacks for events of the store.
    struct Listener {
        /// Called when another server has claimed a session that is open on this server.
        std::function<void(const std::string& id)> claimed;
        /// Called when a save with SaveScope::head has found that the store lacks the session. The listener must save
        /// the session with SaveScope::whole.
        std::function<void(const std::string& id)> missing;
        /// Called when the store becomes available again. The listener must save all open sessions, because the store
        /// may have lost data.
        std::function<void()> recovered;
        /// Called at the end of every operation of the store, for metrics. `operation` is its name, `seconds` its
        /// duration, and `succeeded` says whether it threw no exception.
        std::function<void(const char* operation, double seconds, bool succeeded)> operationEnded;
    };
    /// A session that was read from the cache or the store. If the session was in memory, `session` contains it.
    /// Otherwise, `session` is empty, and the caller must decode `record` with session_codec.hpp. In both cases, the
    /// caller must later pass `record.fence` to save().
    struct FetchedSession {
        std::optional<session::Session> session;
        SessionRecord record;
    };
    using FetchResult = Result<FetchedSession>;
    /// The part of a session to save: only the current state (see encodeHead() in session_codec.hpp), or the whole
    /// session (see encodeWhole()).
    enum class SaveScope : std::uint8_t { head, whole };

    using Clock = std::chrono::steady_clock;

    WriteBehindStore(std::unique_ptr<Store> store, WriteBehindSettings settings, Listener listener,
                     ClockFunction<Clock> now = Clock::now);
    WriteBehindStore(const WriteBehindStore&) = delete;
    WriteBehindStore& operator=(const WriteBehindStore&) = delete;
    ~WriteBehindStore();

    Store::WriteTiming writeTiming() const { return writePolicy_; }
    const std::string& name() const { return name_; }

    /// Creates a session that is open on this server, with the fence kFirstFence. Returns its credentials. The session
    /// is not in the store before it is saved.
    SessionCredentials createSession();

    /// Makes the store thread read a session and pass it to `done`, without claiming the session. Errors are those of
    /// claimAndFetch(). The caller must not save a session that comes as `record`. Does not change the store. A closed
    /// session that is still in memory then counts as open again.
    void read(SessionCredentials credentials, std::function<void(FetchResult)> done);

    /// Makes the store thread claim a session for this server, and call `done` with the session or one of these errors:
    /// `not_found`, `bad_token`, or `internal` if the session cannot be read now. If `done` receives a record, the
    /// caller must decode it and then call setStoredKeys() or, if it cannot be decoded, discardFetched().
    void claimAndFetch(SessionCredentials credentials, std::function<void(FetchResult)> done);

    /// Returns whether this server still owns the session that it has created or fetched with this fence, as far as the
    /// cache knows. If the cache learns later that another server has claimed the session, it calls Listener::claimed,
    /// but not before this function has returned.
    bool ownsSession(const std::string& id, FencingToken fence) const;

    /// Records which objects of a fetched session are in the store, so that they are not written again.
    void setStoredKeys(const std::string& id, KeysBySerial keys);

    /// Records that a session has changes that will soon be saved. unsaved() then counts the session until save() or
    /// closeSession() is called. Does nothing if this server does not own the session with this fence.
    void recordUnsavedChange(const std::string& id, FencingToken fence);

    /// Queues the whole session, or only its current state (SaveScope::head), for writing. `fence` is the fence with
    /// which the caller has created or fetched the session. Calls `written(true)` when the session is stored or, if the
    /// store is unavailable, at once, so that clients need not wait. Calls `written(false)` if the session will never
    /// be stored, because it was removed or evicted, or because another server has claimed it, so that `fence` is out
    /// of date.
    void save(const std::string& id, FencingToken fence, session::Session value, SaveScope scope,
              SaveCallback written = {});

    /// Queues the last write of a session that no client has open anymore. The session stays in memory until it is
    /// written or evicted.
    void closeSession(const std::string& id, session::Session value);

    /// Deletes a closed session from memory and from the store. If the store is unavailable, the deletion from the
    /// store happens later. Does nothing if a client has the session open, on this or another server.
    void remove(const std::string& id);

    /// Removes a fetched session from memory, because its record could not be decoded. Leaves the record in the store
    /// unchanged.
    void discardFetched(const std::string& id);

    /// Returns the approximate number of sessions in the store and in memory together. If several servers share the
    /// store, returns only the number of sessions in this server's memory.
    std::size_t sessionCount() const;
    /// Returns the number of sessions with changes that may not be in the store yet. With WriteTiming::at_close, open
    /// sessions do not count, because sessions are then written only when they are closed.
    std::size_t unsaved() const;
    /// Returns the text of the last error of the store, or an empty string if the store is available.
    std::string lastError() const;

    /// Lets the store thread write pending changes for at most about `limit`, and ends the thread.
    void stop(Milliseconds limit);

  private:
    // A session that is being written, with its changes.
    struct WriteJob {
        std::string id;
        PendingChanges changes;
        // The serial numbers (ObjectInfo::serial) of the objects that this write adds to the store.
        std::vector<std::uint64_t> added;
    };

    // How to fetch a session that is not in memory: only read its record, or also claim the session.
    enum class FetchMode : std::uint8_t { read, claim };
    void queueFetch(SessionCredentials credentials, FetchMode access, std::function<void(FetchResult)> done);

    // The following functions run on the store thread.
    void runThread();
    void writeQueued();
    void takeBatch(std::vector<WriteJob>& jobs, std::vector<RecordUpdate>& updates);
    std::vector<std::optional<SaveResult>> saveMakingRoom(std::span<const RecordUpdate> updates);
    SaveResult saveOneMakingRoom(const RecordUpdate& update);
    std::size_t evictToFit(std::span<const RecordUpdate> updates);
    void writeRemovals();
    void forgetObjectKeys(const std::string& id);
    void applySaveResult(WriteJob& job, const RecordUpdate& update, SaveResult result);
    void requeue(WriteJob& job);
    void dropIfTakenOver(const std::string& id, FencingToken fence);
    void poll();
    void renewAndExpireSessions();
    void runFetch(const SessionCredentials& credentials, FetchMode access,
                  const std::function<void(FetchResult)>& done);
    FetchResult fetch(const SessionCredentials& credentials, FetchMode access);
    template <typename Operation>
    auto runAndReportTime(const char* name, Operation operation);
    void onStoreFailed(const std::exception& fault);
    void onStoreSucceeded();

    // Callers of these functions must hold mutex_.
    bool hasPendingChanges() const { return cached_.queueLength() > 0 || !removals_.empty(); }
    bool isWriteDue() const;
    Clock::time_point nextWakeTime() const;

    const std::unique_ptr<Store> store_;
    const Store::WriteTiming writePolicy_;
    const std::string name_;
    const WriteBehindSettings settings_;
    const Listener listener_;
    const ClockFunction<Clock> now_;

    mutable std::mutex mutex_;
    std::condition_variable wake_;
    // The following members are guarded by mutex_.
    CachedSessions cached_;
    // Tasks that do not use the store. The store thread runs these tasks before all other work.
    std::deque<std::function<void()>> tasks_;
    std::deque<std::function<void()>> requests_;  // calls of read(), claimAndFetch() and remove(), which take turns
                                                  // with writes and polls
    std::set<std::string> removals_;              // ids to remove from the store
    std::size_t storedCount_ = 0;                 // number of sessions in the store at the last poll
    std::size_t neverSaved_ = 0;                  // number of sessions that have never been in the store
    std::string lastError_;
    // `retryAt_` is the earliest time of the next write, and `pollAt_` the time of the next poll().
    Clock::time_point retryAt_, pollAt_;
    Clock::time_point readAt_;  // the earliest time of the next read from the store
    bool stopping_ = false;
    // The time at which the thread ends, even if changes are pending. Valid only if stopping_.
    Clock::time_point stopAt_;

    // Only the store thread uses the following members.
    StoredObjectKeys objects_;
    Backoff backoff_;
    Clock::time_point refreshAt_;  // the time of the next call of renewAndExpireSessions()

    // The last member, because the thread uses all other members, which must be initialized first.
    std::thread storeThread_;
};

}  // namespace oval4d::store
