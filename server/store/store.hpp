#pragma once
// The interface of session stores, the records that they store, and the errors that they report.

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

/// A function that returns the current time of a clock. Tests pass functions that return a virtual time.
template <typename Clock>
using ClockFunction = std::function<typename Clock::time_point()>;

/// The credentials that open a session: its public id and its secret token.
struct SessionCredentials {
    std::string id, token;
};

/// A fencing token: a number that prevents a server from saving a session after another server has claimed it. Each
/// claim increments the fence in the session's record. The store refuses a save whose fence is lower than the fence in
/// the record.
using Fence = std::uint64_t;

/// The fence of a session that no server has claimed since it was created.
inline constexpr Fence kFirstFence = 1;

/// A session as read() and claim() return it from the store.
struct SessionRecord {
    /// `whole`: the whole session, encoded by encodeWhole() (session_codec.hpp). `head`: the state and the revision
    /// after a later change, encoded by encodeHead(); empty if `whole` is the newest state.
    std::string whole, head;
    /// The session's objects that cannot be rebuilt from their names, as pairs (key, encoded object).
    std::vector<std::pair<std::string, std::string>> objects;
    Fence fence = 0;
    std::string damage;  ///< says which part of the record does not match its digest; empty if the record is intact
};

/// A change to the record of a session.
struct RecordUpdate {
    SessionCredentials credentials;
    Fence fence = 0;
    std::string head;   ///< replaces SessionRecord::head, even if it is empty; must not be empty if `whole` is
    std::string whole;  ///< replaces SessionRecord::whole, unless it is empty
    std::vector<std::pair<std::string, std::string>> objects;  ///< (key, encoded object) pairs to add
    std::vector<std::string> dropped;                          ///< keys of objects to remove
    bool closed = false;                                       ///< whether no client has the session open anymore
    bool changed = true;                                       ///< whether the session has changed since its creation
};

/// The result of saving one update.
enum class SaveResult : std::uint8_t {
    saved,
    claimed,  ///< not saved: another server has claimed the session
    missing,  ///< not saved: the store does not have the session, and the update has no `whole`
};

/// A session that another server has claimed.
struct TakenOverSession {
    std::string id;
    Fence fence = 0;  ///< the fence in the session's record; 0 if it has no record anymore

    bool operator==(const TakenOverSession&) const = default;
};

/// Thrown if a store operation fails because the store does not answer, cannot be used, or is full.
class StoreError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// Thrown if the store can be read but not written: its quota is used up, or its disk is full or read-only.
class NotWritable : public StoreError {
  public:
    using StoreError::StoreError;
};

/// Stores the records of sessions by session id. Every function may block, and throws StoreError if the store is
/// unavailable or reports an error. An operation that throws may already have taken effect, fully or in part; the
/// caller may repeat it. Not thread-safe: one thread at a time may call its functions.
class Store {
  public:
    Store() = default;
    Store(const Store&) = delete;
    Store& operator=(const Store&) = delete;
    virtual ~Store() = default;

    /// The time at which changes to an open session must be written to the store.
    enum class WritePolicy : std::uint8_t {
        at_close,  ///< when the last client leaves the session
        soon,      ///< within a second
        at_once,   ///< before the change is acknowledged, because another server may have to take the session over
    };
    /// Returns when changes must be written to this store.
    virtual WritePolicy writePolicy() const = 0;

    /// Returns the name of the store for logs, without passwords, such as "sqlite:/var/lib/oval4d/sessions.sqlite".
    virtual std::string name() const = 0;

    /// Returns the hash of a stored session's token (hashToken() in secret.hpp); an empty optional if the session is
    /// not stored. No store keeps the token itself, except a Redis store that servers of version 0.1.0 may still use.
    virtual std::optional<std::string> tokenHash(const std::string& id) = 0;

    /// Returns whether the record of a session is known to be damaged. If it is, the stored hash may be wrong, so that
    /// even the correct token may not match it.
    virtual bool isDamaged(const std::string& /*id*/) { return false; }

    /// Returns the record of a session, and changes nothing; an empty optional if the session is not stored.
    virtual std::optional<SessionRecord> read(const std::string& id) = 0;

    /// Makes this server the owner of a session, taking it over from another server if necessary. Returns the session's
    /// record; an empty optional if the session is not stored.
    virtual std::optional<SessionRecord> claim(const std::string& id) = 0;

    /// Applies the updates as one batch, and returns one result for each update, in the same order. An update with
    /// `whole` creates the record if the store has none for the session. Throws NotWritable if the batch would exceed
    /// the quota.
    virtual std::vector<SaveResult> save(std::span<const RecordUpdate> updates) = 0;

    /// A function that returns whether the session with this id must not be evicted.
    using IsPinned = std::function<bool(const std::string& id)>;
    /// Called after save() has thrown NotWritable. Evicts sessions that are not pinned until `updates` fit within the
    /// quota, and returns the number of evicted sessions. Evicts first the sessions that were never changed, then those
    /// whose expiry period began first. Evicts none if the updates already fit, because save() then failed for another
    /// reason, such as a full disk. Evicts none, either, if the updates would not fit even if only the pinned sessions
    /// were left.
    virtual std::size_t evict(std::span<const RecordUpdate> updates, const IsPinned& isPinned) = 0;

    /// Removes sessions, except those that another server has claimed.
    virtual void remove(std::span<const std::string> ids) = 0;

    /// Restarts the expiry period of sessions. Saving and claiming a session restart it, too.
    virtual void restartExpiry(std::span<const std::string> ids) = 0;

    /// Removes the sessions whose expiry period began more than `age` ago, and returns their number. Does nothing and
    /// returns 0 if the store expires records itself.
    virtual std::size_t expire(Milliseconds age) = 0;

    /// Updates size(), and returns the sessions that other servers have claimed from this one since the last call. If
    /// this server has claimed such a session back in the meantime, TakenOverSession::fence is the fence of this
    /// server's own claim.
    virtual std::vector<TakenOverSession> pollTakenOverSessions() = 0;

    /// Returns the approximate number of stored sessions, as of the last pollTakenOverSessions().
    virtual std::size_t size() const = 0;
};

/// Returns an estimate of the maximum number of bytes that an update adds to a store.
inline std::size_t estimateStoredSize(const RecordUpdate& update) {
    constexpr std::size_t kOverhead = 640;  // id, hash, times and index entries of a row
    std::size_t bytes = kOverhead + update.head.size() + update.whole.size();
    for (const auto& [key, object] : update.objects) bytes += kOverhead + object.size();
    return bytes;
}

/// The default quota of a store: 1 GiB.
inline constexpr std::size_t kDefaultQuota = std::size_t{1} << 30U;

/// The options of a store, which the operator sets.
struct StoreOptions {
    std::string url = "memory";         ///< "memory", "sqlite:PATH", "redis://[user:password@]host[:port][/database]"
    Milliseconds expiry{1'800'000};     ///< time after which a session that no client has open is deleted
    Milliseconds timeout{1000};         ///< maximum time to wait for a reply of a store on the network
    std::size_t quota = kDefaultQuota;  ///< maximum bytes of the file, or of the records in memory; not used for Redis
};

}  // namespace oval4d::store
