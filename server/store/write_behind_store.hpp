#pragma once
// A write-behind cache of sessions. It uses the store on a thread of its own, so that no other thread waits for a disk
// or a network.

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

/// A write-behind cache in front of a Store: it keeps changes in memory and writes them to the store later. It holds
/// the sessions that are open on this server, and the closed ones whose last change is not yet in the store. Only one
/// thread uses the store: the store thread, which this object starts. If several changes to a session are pending, the
/// cache writes only the newest state.
///
/// The store counts as unavailable after a failed operation, such as a write to a full store, until its operations
/// succeed again. While the store is unavailable, changes wait in memory, and no caller waits for the store; the cache
/// retries with growing pauses (exponential backoff). If the store is full, sessions that no client has open are
/// evicted from it. If the store is unavailable and the closed sessions in memory take more than
/// `WriteBehindSettings::quota`, some of them are evicted from memory. An open session is never evicted.
///
/// Thread-safe. Callbacks must return quickly: they run on the store thread, or on the thread that calls a function of
/// this class.
class WriteBehindStore {
  public:
    struct WriteBehindSettings {
        Milliseconds expiry{1'800'000};  ///< time after which a session that no client has open is deleted
        std::size_t maxUndo = 100;       ///< maximum number of undo steps, and of redo steps, to store with a session
        /// Maximum estimated memory, in bytes, of the closed sessions that wait while the store is unavailable.
        std::size_t quota = kDefaultQuota;
    };
    /// Callbacks for events of the store.
    struct Listener {
        /// Called when another server has claimed a session that is open on this server.
        std::function<void(const std::string& id)> claimed;
        /// Called when only the current state of a session was to be saved, but the store has no record of the session.
        /// The listener must save the session with SaveScope::whole.
        std::function<void(const std::string& id)> missing;
        /// Called when the store is available again. The listener must save all open sessions, because the store may
        /// have lost data.
        std::function<void()> recovered;
        /// Called when an operation of the store has ended, for metrics. `seconds`: its duration.
        std::function<void(const char* operation, double seconds, bool succeeded)> operationEnded;
    };
    /// A fetched session. If the session was still in memory, `session` holds it. Otherwise `session` is empty, and
    /// `record` is the stored record, which the caller must decode with session_codec.hpp. In either case,
    /// `record.fence` is the fence to pass to save().
    struct FetchedSession {
        std::optional<session::Session> session;
        SessionRecord record;
    };
    using FetchResult = Result<FetchedSession>;
    /// The part of a session to save: the result of encodeHead() or of encodeWhole() (session_codec.hpp).
    enum class SaveScope : std::uint8_t { head, whole };

    using Clock = std::chrono::steady_clock;

    WriteBehindStore(std::unique_ptr<Store> store, WriteBehindSettings settings, Listener listener,
                     ClockFunction<Clock> now = Clock::now);
    WriteBehindStore(const WriteBehindStore&) = delete;
    WriteBehindStore& operator=(const WriteBehindStore&) = delete;
    ~WriteBehindStore();

    Store::WritePolicy writePolicy() const { return writePolicy_; }
    const std::string& name() const { return name_; }

    /// Creates a session that is open on this server, with the fence kFirstFence, and returns its credentials. The
    /// session is not in the store until it is saved.
    SessionCredentials create();

    /// Makes the store thread read a session, and then call `done` as claimAndFetch() does. A session in memory is
    /// passed as by claimAndFetch(). Any other session is not claimed, and `record` must not be written: nothing
    /// changes, neither in memory nor in the store.
    void read(SessionCredentials credentials, std::function<void(FetchResult)> done);

    /// Makes the store thread claim a session for this server and then call `done` with the session or with an error:
    /// `not_found`, `bad_token`, or `internal` if the session cannot be fetched now. If `done` receives a record, the
    /// caller must decode it, and then call setStoredKeys() or, if the record cannot be decoded, discardFetched().
    void claimAndFetch(SessionCredentials credentials, std::function<void(FetchResult)> done);

    /// Returns whether, as far as the cache knows, this server still owns the session that it has created or fetched
    /// with this fence. If the cache learns later that another server has claimed the session, it calls
    /// Listener::claimed, and not before this function has returned.
    bool owns(const std::string& id, Fence fence) const;

    /// Records which objects of a fetched session the store already has, so that they are not written again.
    void setStoredKeys(const std::string& id, KeysBySerial keys);

    /// Records that a session has changes that will soon be saved: unsaved() counts the session until it is passed to
    /// save() or close(). Does nothing if this server does not own the session with this fence.
    void noteChange(const std::string& id, Fence fence);

    /// Queues the whole session for writing, or only its current state (SaveScope::head). `fence`: the fence with which
    /// the caller has created or fetched the session. Calls `written(true)` when the session is stored, or at once if
    /// the store is unavailable, so that clients need not wait. Calls `written(false)` if the session will never be
    /// stored, because it was removed or evicted, or because another server has taken it over. In the last case,
    /// `fence` is out of date, even if this server has fetched the session again.
    void save(const std::string& id, Fence fence, session::Session value, SaveScope scope, SaveCallback written = {});

    /// Queues the last write of a session that no client has open anymore. The session stays in memory until it is
    /// written.
    void close(const std::string& id, session::Session value);

    /// Deletes a closed session from memory and from the store. While the store is unavailable, the deletion from the
    /// store is pending. Does nothing if a client has the session open, on this server or another.
    void remove(const std::string& id);

    /// Drops a fetched session from memory, because its record could not be decoded. Does not change the record.
    void discardFetched(const std::string& id);

    /// Returns the approximate number of sessions in the store and in memory. If several servers share the store,
    /// returns only the number of sessions in this server's memory.
    std::size_t sessionCount() const;
    /// Returns the number of sessions with changes that are not known to be in the store. If sessions are written only
    /// when they are closed (WritePolicy::at_close), those that are open do not count.
    std::size_t unsaved() const;
    /// Returns the text of the last error of the store; an empty string while the store is available.
    std::string lastError() const;

    /// Writes pending changes for at most about `limit`, and then ends the store thread.
    void stop(Milliseconds limit);

  private:
    // One write of a session.
    struct Job {
        std::string id;
        PendingChanges changes;
        std::vector<std::uint64_t> added;  // ObjectInfo::serial of the objects that this write adds to the store
    };

    // What a fetch does with a session that is not in memory: only reads its record, or claims it, too.
    enum class Access : std::uint8_t { read, claim };
    void queueFetch(SessionCredentials credentials, Access access, std::function<void(FetchResult)> done);

    // The following functions run on the store thread.
    void runThread();
    void write();
    void takeJobs(std::vector<Job>& jobs, std::vector<RecordUpdate>& updates);
    std::vector<std::optional<SaveResult>> saveMakingRoom(std::span<const RecordUpdate> updates);
    SaveResult saveOneMakingRoom(const RecordUpdate& update);
    std::size_t evictFor(std::span<const RecordUpdate> updates);
    void writeRemovals();
    void dropKeys(const std::string& id);
    void applyResult(Job& job, const RecordUpdate& update, SaveResult result);
    void requeue(Job& job);
    void dropIfTakenOver(const std::string& id, Fence fence);
    void poll();
    void renewAndExpireSessions();
    void runFetch(const SessionCredentials& credentials, Access access, const std::function<void(FetchResult)>& done);
    FetchResult fetch(const SessionCredentials& credentials, Access access);
    template <typename Operation>
    auto runTimed(const char* name, Operation operation);
    void storeFailed(const std::exception& fault);
    void storeWorked();

    // The caller of these functions must hold mutex_.
    bool hasPendingChanges() const { return cached_.queueLength() > 0 || !removals_.empty(); }
    bool isReadyToWrite() const;
    Clock::time_point nextWake() const;

    const std::unique_ptr<Store> store_;
    const Store::WritePolicy writePolicy_;
    const std::string name_;
    const WriteBehindSettings settings_;
    const Listener listener_;
    const ClockFunction<Clock> now_;

    mutable std::mutex mutex_;
    std::condition_variable wake_;
    // Guarded by mutex_.
    CachedSessions cached_;
    std::deque<std::function<void()>> tasks_;  // do not use the store; the store thread runs them before all else
    std::deque<std::function<void()>>
        requests_;                    // calls of read(), claimAndFetch(), remove(); take turns with writes and polls
    std::set<std::string> removals_;  // ids to remove from the store
    std::size_t storedCount_ = 0;     // number of sessions in the store, as of the last poll
    std::size_t neverSaved_ = 0;      // number of sessions that have never been in the store
    std::string lastError_;
    Clock::time_point retryAt_, pollAt_;  // retryAt_: earliest time of the next write; pollAt_: time of the next poll()
    Clock::time_point readAt_;            // earliest time of the next read
    bool stopping_ = false;
    Clock::time_point stopAt_;  // if `stopping_`: the time at which the thread ends even if changes are pending

    // Used only by the store thread.
    StoredObjectKeys objects_;
    Backoff backoff_;
    Clock::time_point refreshAt_;  // time of the next renewAndExpireSessions()

    std::thread storeThread_;  // the last member, so that the others are initialized before the thread uses them
};

}  // namespace oval4d::store
