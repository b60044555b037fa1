#pragma once
// Flow control for the pictures that are sent to one client.

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>

namespace oval4d::net {

/// Tracks the pictures on their way to one client. Each picture is sent (queued), then written to the socket, then
/// shown by the client. At most kInFlight pictures may be sent but not yet shown: two are enough to keep the client
/// busy, and few enough that the client need not show many outdated pictures.
class Pacing {
  public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::size_t kInFlight = 2;

    /// Returns whether one more picture may be sent, in addition to `pending` pictures that are still being made.
    bool hasRoom(std::size_t pending = 0) const { return unshown_.size() + pending < kInFlight; }
    /// Returns the newest revision that was sent or skipped; an empty optional if there is none.
    std::optional<std::uint64_t> newestSentOrSkipped() const { return newest_; }

    /// Records that the picture of this revision was queued for the client.
    void recordSent(std::uint64_t revision);
    /// Records that the client will receive no picture of this revision.
    void recordSkipped(std::uint64_t revision) { newest_ = revision; }
    /// Records that the picture of this revision was written to the socket.
    void recordWritten(std::uint64_t revision, Clock::time_point now);
    /// Records that the client has shown this revision, and hence all earlier ones.
    void recordShown(std::uint64_t revision);

    /// Marks as shown the pictures that were written at least `timeout` ago, because some clients do not acknowledge
    /// pictures.
    void assumeShown(Clock::time_point now, Clock::duration timeout);
    /// Returns the time from which assumeShown() with this `timeout` marks the oldest unshown picture as shown. Returns
    /// an empty optional if there is no such picture, or if that picture is not yet written.
    std::optional<Clock::time_point> deadline(Clock::duration timeout) const;

  private:
    struct UnshownPicture {
        std::uint64_t revision;
        std::optional<Clock::time_point> written;  // empty until the picture is written to the socket
    };
    std::optional<std::uint64_t> newest_;
    std::deque<UnshownPicture> unshown_;  // pictures sent but not shown, the oldest first
};

}  // namespace oval4d::net
