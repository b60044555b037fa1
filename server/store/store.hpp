#pragma once
// The interface of session stores: what they store, and how they report failures.

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

/// Wall-clock time, because a store may outlive the process.
using Time = std::chrono::system_clock::time_point;
using Milliseconds = std::chrono::milliseconds;

/// What a client needs to open a session: its public id and its secret token.
struct SessionCredentials {
    std::string id, token;
};

/// Fencing token: each claim of a session increments its fence, and the store refuses a save with a lower fence than
/// the record's.
using Fence = std::uint64_t;

/// A stored session, as encoded by codec.hpp. `objects` are (key, encoded object) pairs of the objects that have
/// no name in the catalogue.
struct Record {
    std::string whole, head;
    std::vector<std::pair<std::string, std::string>> objects;
    Fence fence = 0;
    std::string damage;  ///< which part does not match its digest; empty if the record is intact
};

/// A change to a record.
struct RecordUpdate {
    SessionCredentials credentials;
    Fence fence = 0;
    std::string head;                                          ///< empty: unchanged
    std::string whole;                                         ///< empty: unchanged; else `head` is replaced too
    std::vector<std::pair<std::string, std::string>> objects;  ///< to add
    std::vector<std::string> dropped;                          ///< keys of objects to remove
    bool last = false;                                         ///< no client has the session open anymore
    bool changed = true;                                       ///< the session has changed since its creation
};

/// The result of one update.
enum class SaveResult : std::uint8_t {
    saved,
    taken,    ///< not saved: another server has claimed the session
    missing,  ///< not saved: the store does not have the session, and the update has no `whole`
};

/// A store operation failed: the store does not answer, cannot be used, or is full.
class StoreError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// The store can be read but not written: its quota is used up, or its disk is full or read-only.
class NotWritable : public StoreError {
  public:
    using StoreError::StoreError;
};

/// Maps session ids to records. Every function may block, and throws StoreError if the store fails; the operation may
/// then have had no effect or a partial one, and may be repeated. Not thread-safe: one thread at a time may call it.
class Store {
  public:
    Store() = default;
    Store(const Store&) = delete;
    Store& operator=(const Store&) = delete;
    virtual ~Store() = default;

    /// When the changes of an open session are written to the store.
    enum class WritePolicy : std::uint8_t {
        at_close,  ///< when the last client leaves
        soon,      ///< within a second
        at_once,   ///< before the change is acknowledged, because another server may have to take over
    };
    virtual WritePolicy writePolicy() const = 0;

    /// The name for logs, without passwords, such as "sqlite:/var/lib/oval4d/sessions.sqlite".
    virtual std::string name() const = 0;

    /// The hash of a stored session's token (hashOf in secret.hpp), or nothing if the session is not stored. No store
    /// keeps the token itself, except Redis while servers of version 0.1.0 may still use it.
    virtual std::optional<std::string> tokenHash(const std::string& id) = 0;

    /// Whether a session's record is known to be damaged, so that even the right token may not match its hash.
    virtual bool isDamaged(const std::string& /*id*/) { return false; }

    /// Takes a session over from the server that owns it, and returns its record; nothing if it is not stored.
    virtual std::optional<Record> claim(const std::string& id) = 0;

    /// Applies the updates as one batch, and returns one result for each. Creates the record of a session that the
    /// store has lost or never had. Throws NotWritable if the batch would exceed the quota.
    virtual std::vector<SaveResult> save(std::span<const RecordUpdate> updates) = 0;

    /// Whether a session must not be evicted.
    using IsPinned = std::function<bool(const std::string& id)>;
    /// Evicts sessions until `updates` fit within the quota, and returns their number: first those that were never
    /// changed, then those that were not saved or touched for the longest time. Evicts none if the store cannot be
    /// written for another reason than its quota.
    virtual std::size_t evict(std::span<const RecordUpdate> updates, const IsPinned& isPinned) = 0;

    /// Removes sessions, except those that another server has claimed.
    virtual void remove(std::span<const std::string> ids) = 0;

    /// Restarts the expiry period of sessions.
    virtual void touch(std::span<const std::string> ids) = 0;

    /// Removes the sessions that were not saved or touched for `age`, and returns their number. Does nothing in a store
    /// that expires records itself.
    virtual std::size_t expire(Milliseconds age) = 0;

    /// Polls the store: returns the sessions that other servers have claimed from this one since the last poll, and
    /// updates size().
    virtual std::vector<std::string> poll() = 0;

    /// The approximate number of stored sessions, as of the last poll().
    virtual std::size_t size() const = 0;
};

/// An estimate of the most bytes that an update adds to a store.
inline std::size_t bytesOf(const RecordUpdate& update) {
    constexpr std::size_t kOverhead = 640;  // id, hash, times and index entries of a row
    std::size_t bytes = kOverhead + update.head.size() + update.whole.size();
    for (const auto& [key, object] : update.objects) bytes += kOverhead + object.size();
    return bytes;
}

inline constexpr std::size_t kDefaultQuota = std::size_t{1} << 30U;

/// The operator's choice of a store.
struct StoreOptions {
    std::string url = "memory";         ///< "memory", "sqlite:PATH", "redis://[user:password@]host[:port][/database]"
    Milliseconds expiry{1'800'000};     ///< lifetime of a session that no client has open
    Milliseconds timeout{1000};         ///< for a reply of a store on the network
    std::size_t quota = kDefaultQuota;  ///< bytes of the file or of the records in memory; Redis has `maxmemory`
};

}  // namespace oval4d::store
