#pragma once
// Reads and writes sessions on a thread of its own, so that no other thread waits for a disk or a network.

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <random>
#include <set>
#include <span>
#include <thread>

#include "errors/error.hpp"
#include "session/session.hpp"
#include "store/store.hpp"

namespace oval4d::store {

/// A write-behind cache in front of a Store. It holds the sessions that are open on this server, and the closed ones
/// whose last change is not yet in the store. Only its own thread uses the store; of several pending changes to a
/// session, it writes the newest.
///
/// While the store fails, changes wait in memory, the store is retried with growing pauses, and no caller waits for it.
/// If the store is full, sessions that no client has open are evicted from it; if the closed sessions that wait for a
/// failing store would take more memory than `Settings::quota`, they are evicted from memory. An open session is never
/// evicted.
///
/// Thread-safe. Callbacks run on the write-behind store's thread or within the call, and must return quickly.
class WriteBehindStore {
  public:
    struct Settings {
        Milliseconds expiry{1'800'000};  ///< lifetime of a session that no client has open
        std::size_t maxUndo = 100;       ///< undo steps, and redo steps, that are stored
        /// estimated bytes of the closed sessions that wait in memory for a failing store
        std::size_t quota = kDefaultQuota;
    };
    /// Callbacks.
    struct Listener {
        /// another server has claimed this session
        std::function<void(const std::string& id)> claimed;
        /// the store lacks this session: save it with SaveScope::whole
        std::function<void(const std::string& id)> missing;
        /// the store works again, and may have lost data: save all sessions
        std::function<void()> recovered;
        /// an operation of the store has ended; for metrics
        std::function<void(const char* operation, double seconds, bool succeeded)> operationEnded;
    };
    /// A fetched session: a value if it was still in memory, else a record to be decoded with codec.hpp.
    struct Fetched {
        std::optional<session::Session> session;
        Record record;
    };
    using FetchResult = Result<Fetched>;
    /// The keys under which a session's objects are stored, by ObjectInfo::serial.
    using Keys = std::map<std::uint64_t, std::string>;
    /// Called when a save has ended: see save().
    using Written = std::function<void(bool)>;
    /// The parts of a record: see encodeHead and encodeWhole in codec.hpp.
    enum class SaveScope : std::uint8_t { head, whole };

    WriteBehindStore(std::unique_ptr<Store> store, Settings settings, Listener listener);
    WriteBehindStore(const WriteBehindStore&) = delete;
    WriteBehindStore& operator=(const WriteBehindStore&) = delete;
    ~WriteBehindStore();

    Store::WritePolicy writePolicy() const { return writePolicy_; }
    const std::string& name() const { return name_; }

    /// Creates a session that is open on this server. It is not in the store until it is saved.
    SessionCredentials create();

    /// Claims a session for this server. Calls `done` with the session, or with an error: `not_found`, `bad_token`, or
    /// `internal` if the store does not answer.
    void fetch(SessionCredentials credentials, std::function<void(FetchResult)> done);

    /// Tells which of a fetched session's objects the store has, after its record was decoded.
    void setStoredKeys(const std::string& id, Keys keys);

    /// Queues a session for writing: the whole of it, or with SaveScope::head only its current state. Calls `written`
    /// with true when it is in the store, or immediately while the store fails; with false if this server no longer
    /// owns the session.
    void save(const std::string& id, session::Session value, SaveScope scope, Written written = {});

    /// Queues the last write of a session that no client has open anymore.
    void close(const std::string& id, session::Session value);

    /// Deletes a closed session here and in the store; if the store fails, it is deleted there later. Does nothing if a
    /// client has the session open, on this server or another.
    void remove(const std::string& id);

    /// Drops a session that was fetched but could not be decoded. Its record in the store is unchanged.
    void release(const std::string& id);

    /// The approximate number of sessions in the store and in memory; only those in memory if servers share the store.
    std::size_t count() const;
    /// The number of sessions with changes that are not known to be in the store.
    std::size_t unsaved() const;
    /// The store's last error; empty while it works.
    std::string lastError() const;

    /// Writes the pending changes, for at most `limit`, and ends the thread.
    void stop(Milliseconds limit);

  private:
    using Clock = std::chrono::steady_clock;
    using Value = std::shared_ptr<const session::Session>;
    struct Held {
        SessionCredentials credentials;
        Fence fence = 1;
        Value head, whole;  ///< to be written
        std::vector<Written> waiting;
        bool saved = false;  ///< has been in the store
        bool queued = false;
        bool inFlight = false;  ///< is being written
        bool closed = false;    ///< no client has it open: dropped once written
        Clock::time_point closedAt;
        std::size_t bytes = 0;  ///< estimated memory of a closed session
    };
    /// An object's key, and whether the store has the object.
    struct ObjectKey {
        std::string key;
        bool stored = false;
    };
    using ObjectKeys = std::map<std::uint64_t, ObjectKey>;
    /// One write of a session.
    struct Job {
        std::string id;
        Value head, whole;
        std::vector<Written> waiting;
        std::vector<std::uint64_t> added;  ///< serials of the objects that it adds to the store
    };

    // On the thread of the write-behind store.
    void run();
    void write();
    void takeJobs(std::vector<Job>& jobs, std::vector<RecordUpdate>& updates);
    void encode(Job& job, RecordUpdate& update);
    std::vector<std::optional<SaveResult>> saveOrEvict(std::span<const RecordUpdate> updates);
    void writeRemovals();
    void dropKeys(const std::string& id);
    void applyResult(Job& job, const RecordUpdate& update, SaveResult result);
    void requeue(Job& job);
    void dropTaken(const std::string& id);
    void poll();
    void refreshExpiry();
    void fetchNow(const SessionCredentials& credentials, const std::function<void(FetchResult)>& done);
    FetchResult claimOrFind(const SessionCredentials& credentials);
    template <typename Operation>
    auto timed(const char* name, Operation operation);
    void storeFailed(const std::exception& fault);
    void storeWorked();

    // With mutex_ held.
    void enqueue(const std::string& id, Held& held);
    void recount();
    std::vector<Held> evictClosed();
    bool mayWrite() const;
    Clock::time_point nextWake() const;

    const std::unique_ptr<Store> store_;
    const Store::WritePolicy writePolicy_;
    const std::string name_;
    const Settings settings_;
    const Listener listener_;

    mutable std::mutex mutex_;
    std::condition_variable wake_;
    // Guarded by mutex_.
    std::map<std::string, Held, std::less<>> held_;
    std::deque<std::string> queue_;            // ids of sessions with pending changes
    std::deque<std::function<void()>> tasks_;  // run by the thread before it writes
    std::set<std::string> removals_;           // ids to remove from the store
    std::size_t kept_ = 0;                     // sessions in the store, as of the last poll
    std::size_t created_ = 0;                  // sessions that have never been in the store
    std::string lastError_;
    Clock::time_point retryAt_, pollAt_;  // earliest next write, next poll
    Clock::time_point readAt_;            // earliest next read
    bool stopping_ = false;
    Clock::time_point stopAt_;

    // Used by the thread alone.
    std::map<std::string, ObjectKeys, std::less<>> keys_;  // by session id
    int failures_ = 0;                                     // in a row
    Clock::time_point refreshAt_;
    std::minstd_rand random_;

    std::thread thread_;  // last: it uses the other members
};

}  // namespace oval4d::store
