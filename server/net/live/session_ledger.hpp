#pragma once
// The sessions of each client, so that one client cannot use up the limit of all.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace oval4d::net {

/// Records which client opened each session of this process, both open sessions and closed ones that have not expired.
/// Finds the sessions to evict when a limit is reached: unmodified closed ones, the longest closed first. Not
/// thread-safe.
class SessionLedger {
  public:
    using Clock = std::chrono::steady_clock;

    /// `expiry`: the time after which a closed session is forgotten.
    explicit SessionLedger(Clock::duration expiry) : expiry_(expiry) {}

    /// Records that a client has opened a session. A known session stays assigned to the client that opened it first.
    void open(const std::string& id, const std::string& client);

    /// Records that a session has no client any more. `unmodified`: it was never changed.
    void close(const std::string& id, bool unmodified, Clock::time_point now);

    /// Removes a session that was deleted or was taken over by another server.
    void remove(const std::string& id);

    /// The number of sessions of a client, open and closed.
    std::size_t count(const std::string& client, Clock::time_point now);

    /// The unmodified closed session that was closed first, of one client or, without `client`, of all. Nothing if
    /// there is none.
    std::optional<std::string> oldestUnmodified(Clock::time_point now, const std::string* client = nullptr);

  private:
    struct Entry {
        std::string client;
        std::uint64_t closed = 0;  // sequence number of closing; 0 while open
        bool unmodified = false;
        Clock::time_point expires;
    };
    struct ClientSessions {
        std::size_t sessions = 0;
        std::map<std::uint64_t, std::string> unmodified;  // ids by sequence number
    };
    using Sessions = std::map<std::string, Entry, std::less<>>;

    void expire(Clock::time_point now);
    void reopen(Entry& entry);
    void erase(Sessions::iterator session);

    const Clock::duration expiry_;
    Sessions sessions_;
    std::map<std::string, ClientSessions, std::less<>> clients_;  // by client name
    std::map<std::uint64_t, std::string> closed_;                 // ids by sequence number
    std::map<std::uint64_t, std::string> unmodified_;             // the unmodified ones among these
    std::uint64_t last_ = 0;
};

}  // namespace oval4d::net
