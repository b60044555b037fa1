#pragma once
// Flow control for the pictures that one client receives.

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>

namespace oval4d::net {

/// Tracks the pictures on their way to one client. A picture is sent (queued), then written to the socket, then shown
/// by the client. At most kInFlight pictures may be sent but not yet shown. This number is enough to keep the client
/// busy, and so small that the client shows hardly any outdated picture.
class PicturePacing {
  public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::size_t kInFlight = 2;

    /// Returns whether one more picture may be sent. `pending` is the number of pictures for the client that are still
    /// being made; they count as sent.
    bool maySendMore(std::size_t pending = 0) const { return unshown_.size() + pending < kInFlight; }
    /// Returns the newest revision that was sent or skipped; an empty optional before the first.
    std::optional<std::uint64_t> newestRevisionSentOrSkipped() const { return newest_; }

    /// Records that the picture of this revision has been queued for the client.
    void recordSent(std::uint64_t revision);
    /// Records that the client will receive no picture of this revision.
    void recordSkipped(std::uint64_t revision) { newest_ = revision; }
    /// Records that the picture of this revision has been written to the socket.
    void recordWritten(std::uint64_t revision, Clock::time_point now);
    /// Records that the client has shown this revision, and hence all earlier ones.
    void recordShown(std::uint64_t revision);

    /// Marks pictures as shown that were written at least `timeout` ago, because some clients do not acknowledge
    /// pictures.
    void assumeShown(Clock::time_point now, Clock::duration timeout);
    /// Returns when assumeShown() with this `timeout` will mark the oldest unshown picture as shown. Returns an empty
    /// optional if there is no such picture, or if it has not been written yet.
    std::optional<Clock::time_point> assumeShownTime(Clock::duration timeout) const;

  private:
    struct UnshownPicture {
        std::uint64_t revision;
        std::optional<Clock::time_point> written;  // empty until the picture is written to the socket
    };
    std::optional<std::uint64_t> newest_;  // the newest revision that was sent or skipped
    std::deque<UnshownPicture> unshown_;   // pictures sent but not shown, the oldest first
};

}  // namespace oval4d::net
