#pragma once
// Records the sessions of each client, so that no client can use up the sessions allowed for all clients.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace oval4d::net {

/// Records which client has opened each session of this process: open sessions, and closed sessions that have not
/// expired. At a limit, finds the session to evict: of the closed sessions that were never changed, the one that was
/// closed first. Not thread-safe.
class SessionsByClient {
  public:
    using Clock = std::chrono::steady_clock;

    /// `expiry` is the time after which a closed session is forgotten.
    explicit SessionsByClient(Clock::duration expiry) : expiry_(expiry) {}

    /// Records that a client has opened a session. A session that is already recorded stays with its first client.
    void recordOpened(const std::string& id, const std::string& client);

    /// Records that a session no longer has a client. `unmodified` tells whether the session was never changed.
    void recordClosed(const std::string& id, bool unmodified, Clock::time_point now);

    /// Removes a session that was deleted or was taken over by another server.
    void remove(const std::string& id);

    /// Returns how many sessions of this client are open, or closed and not expired.
    std::size_t countSessionsOf(const std::string& client, Clock::time_point now);

    /// Among the closed sessions that were never changed, returns the id of the one that was closed first. If `client`
    /// is not null, considers only sessions of this client. Returns an empty optional if there is no such session.
    std::optional<std::string> firstClosedUnmodified(Clock::time_point now, const std::string* client = nullptr);

  private:
    struct RecordedSession {
        std::string client;
        std::uint64_t closed = 0;  // the session's number in the order of closing, from 1; 0 while it is open
        bool unmodified = false;
        Clock::time_point expires;  // when a closed session is forgotten
    };
    struct ClientSessions {
        std::size_t sessions = 0;
        std::map<std::uint64_t, std::string> unmodified;  // the ids of closed unmodified sessions, in order of closing
    };
    using SessionsById = std::map<std::string, RecordedSession, std::less<>>;

    void expire(Clock::time_point now);
    void reopen(RecordedSession& session);
    void erase(SessionsById::iterator session);

    const Clock::duration expiry_;
    SessionsById sessions_;
    std::map<std::string, ClientSessions, std::less<>> clients_;  // by client name
    std::map<std::uint64_t, std::string> closed_;                 // the ids of closed sessions, in order of closing
    std::map<std::uint64_t, std::string> unmodified_;             // the ids of closed sessions that were never changed
    std::uint64_t last_ = 0;                                      // the last value given to RecordedSession::closed
};

}  // namespace oval4d::net
