#pragma once
// The interface of session stores, their records, and their errors.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace oval4d::store {

using Milliseconds = std::chrono::milliseconds;

/// A function that returns the current time of a clock. Tests use functions that return a time of their own.
template <typename Clock>
using ClockFunction = std::function<typename Clock::time_point()>;

/// The credentials with which a client opens a session: its public id and its secret token.
struct SessionCredentials {
    std::string id, token;
};

/// A fencing token: the number of a claim. It prevents a server from saving a session after another server has claimed
/// the session (become its owner). Each claim increments the fence in the session's record. The store refuses a save
/// with a lower fence than that in the record.
using FencingToken = std::uint64_t;

/// The fence of a new session, which no server has claimed yet.
inline constexpr FencingToken kFirstFence = 1;

/// The record of a session, as read() and claim() return it.
struct SessionRecord {
    /// `whole` is the whole session, encoded by encodeWhole() (session_codec.hpp). `head` is a later current state with
    /// its revision, encoded by encodeHead(); empty if `whole` contains the latest state.
    std::string whole, head;
    /// The session's objects that cannot be built from their names, as pairs (key, encoded object).
    std::vector<std::pair<std::string, std::string>> objects;
    FencingToken fence = 0;
    /// Which part of the record does not match its digest. Empty if the record is intact.
    std::string damage;
};

/// A change to the record of a session.
struct RecordUpdate {
    SessionCredentials credentials;
    FencingToken fence = 0;
    /// The new SessionRecord::head, which may be empty. Must not be empty if `whole` is empty.
    std::string head;
    std::string whole;  ///< the new SessionRecord::whole; empty if it stays the same
    /// Objects to add, as pairs (key, encoded object).
    std::vector<std::pair<std::string, std::string>> objects;
    std::vector<std::string> dropped;  ///< keys of objects to remove from the record
    bool closed = false;               ///< whether no client has the session open anymore
    bool changed = true;               ///< whether the session has changed since its creation
};

/// The result of saving one update.
enum class SaveResult : std::uint8_t {
    saved,
    claimed,  ///< not saved, because another server has claimed the session
    missing,  ///< not saved, because the store lacks the session and RecordUpdate::whole is empty
};

/// A session that another server has claimed from this server.
struct TakenOverSession {
    std::string id;
    FencingToken fence = 0;  ///< the fence in the session's record; 0 if the record was deleted

    bool operator==(const TakenOverSession&) const = default;
};

/// An error of a store: the store does not answer, cannot be used, or is full.
class StoreError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// An error of a store that can be read but not written: its quota is used up, or its disk is full or read-only.
class StoreNotWritable : public StoreError {
  public:
    using StoreError::StoreError;
};

/// A store of session records, by session id. Every function may block, and throws StoreError if the store is
/// unavailable or reports an error. An operation that throws may have taken effect, fully or in part; the caller may
/// repeat it. Not thread-safe: callers must not call functions concurrently.
class Store {
  public:
    Store() = default;
    Store(const Store&) = delete;
    Store& operator=(const Store&) = delete;
    virtual ~Store() = default;

    /// The latest time at which a change to an open session must be written to the store.
    enum class WriteTiming : std::uint8_t {
        at_close,  ///< when the last client leaves the session
        soon,      ///< within a second
        at_once,   ///< before the server acknowledges the change, because another server may claim the session
    };
    /// Returns when changes must be written to this store at the latest.
    virtual WriteTiming writeTiming() const = 0;

    /// Returns the name of the store for logs, without passwords, such as "sqlite:/var/lib/oval4d/sessions.sqlite".
    virtual std::string name() const = 0;

    /// Returns the hash of a stored session's token, as hashToken() in secret.hpp computes it. Returns an empty
    /// optional if the session is not stored. The token itself is stored only in a Redis that servers of version 0.1.0
    /// may still use.
    virtual std::optional<std::string> tokenHash(const std::string& id) = 0;

    /// Returns whether the record of a session is known to be damaged. If so, the stored hash may be wrong, so that
    /// even the correct token does not match it.
    virtual bool isDamaged(const std::string& /*id*/) { return false; }

    /// Returns the record of a session, or an empty optional if the session is not stored. Changes nothing.
    virtual std::optional<SessionRecord> read(const std::string& id) = 0;

    /// Makes this server the owner of a session, even if another server owns it. Returns the session's record, or an
    /// empty optional if the session is not stored.
    virtual std::optional<SessionRecord> claim(const std::string& id) = 0;

    /// Applies the updates as one batch. Returns one result for each update, in the same order. An update with `whole`
    /// creates the session's record if the store lacks it. Throws StoreNotWritable if the batch would exceed the quota.
    virtual std::vector<SaveResult> save(std::span<const RecordUpdate> updates) = 0;

    /// A function that returns whether the session with this id must not be evicted (deleted to free space).
    using PinnedPredicate = std::function<bool(const std::string& id)>;
    /// Evicts sessions that are not pinned until `updates` fit within the quota, and returns the number of evicted
    /// sessions. Called after save() has thrown StoreNotWritable. Evicts sessions that were never changed first, then
    /// those that have not been used for the longest time. Evicts none if the updates already fit, because save() then
    /// failed for another reason, such as a full disk. Evicts none, either, if the updates would not fit next to the
    /// pinned sessions alone.
    virtual std::size_t evict(std::span<const RecordUpdate> updates, const PinnedPredicate& isPinned) = 0;

    /// Removes the sessions with these ids from the store, except sessions that another server has claimed.
    virtual void remove(std::span<const std::string> ids) = 0;

    /// Restarts the expiry period of the sessions with these ids, as saving or claiming a session does.
    virtual void restartExpiry(std::span<const std::string> ids) = 0;

    /// Removes the sessions whose expiry period began more than `age` ago. Returns their number. Does nothing and
    /// returns 0 if the store expires records itself.
    virtual std::size_t expire(Milliseconds age) = 0;

    /// Updates size(). Returns the sessions that other servers have claimed from this server since the last call. If
    /// this server has claimed such a session back, TakenOverSession::fence is the fence of this server's own claim.
    virtual std::vector<TakenOverSession> pollTakenOverSessions() = 0;

    /// Returns the approximate number of stored sessions, as of the last pollTakenOverSessions().
    virtual std::size_t size() const = 0;
};

/// Returns an estimate of the number of bytes by which an update enlarges a store at most.
inline std::size_t estimateStoredSize(const RecordUpdate& update) {
    constexpr std::size_t kOverhead = 640;  // bytes for the id, the hash, the times and the index entries of a row
    std::size_t bytes = kOverhead + update.head.size() + update.whole.size();
    for (const auto& [key, object] : update.objects) bytes += kOverhead + object.size();
    return bytes;
}

/// The default quota of a store: 1 GiB.
inline constexpr std::size_t kDefaultQuota = std::size_t{1} << 30U;

/// The options of a session store. The operator of the server sets them.
struct StoreOptions {
    std::string url = "memory";         ///< "memory", "sqlite:PATH" or "redis://[user:password@]host[:port][/database]"
    Milliseconds expiry{1'800'000};     ///< time after which a session is deleted if no client has it open
    Milliseconds timeout{1000};         ///< maximum time to wait for the reply of a Redis server
    std::size_t quota = kDefaultQuota;  ///< maximum size of the file, or of the records in memory, in bytes; not used
                                        ///< for Redis
};

}  // namespace oval4d::store
