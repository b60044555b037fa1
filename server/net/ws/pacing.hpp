#pragma once
// The flow control of pictures to one client.

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>

namespace oval4d::net {

/// Tracks the pictures on their way to one client: sent, then written to its socket, then shown. At most kInFlight may
/// be sent but not yet shown: two keep the client busy, and no queue of outdated pictures can form.
class Pacing {
  public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::size_t kInFlight = 2;

    /// Whether one more picture may be sent, in addition to `pending` pictures that are still being made.
    bool hasRoom(std::size_t pending = 0) const { return unshown_.size() + pending < kInFlight; }
    /// The newest revision sent or skipped, if any.
    std::optional<std::uint64_t> newest() const { return newest_; }

    /// Records that the picture of this revision was queued for the client.
    void sent(std::uint64_t revision);
    /// Records that the client gets no picture of this revision.
    void skipped(std::uint64_t revision) { newest_ = revision; }
    /// Records that the picture of this revision was written to the socket.
    void written(std::uint64_t revision, Clock::time_point now);
    /// Records that the client has shown this revision, and hence all earlier ones.
    void shown(std::uint64_t revision);

    /// Counts pictures as shown that were written at least `timeout` ago, for clients that do not acknowledge them.
    void expire(Clock::time_point now, Clock::duration timeout);
    /// The time at which the oldest picture expires; nothing if it is not yet written or there is none.
    std::optional<Clock::time_point> deadline(Clock::duration timeout) const;

  private:
    struct Picture {
        std::uint64_t revision;
        std::optional<Clock::time_point> written;
    };
    std::optional<std::uint64_t> newest_;
    std::deque<Picture> unshown_;  // oldest first
};

}  // namespace oval4d::net
