#pragma once
// How many pictures a client may have before it has shown them.

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>

namespace oval4d::net {

/// The pictures on their way to one client: sent, then written to its socket, then shown. Two may be unshown, so that
/// the next is ready when the client has presented one, and no queue of stale ones can form.
class Pacing {
  public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::size_t kInFlight = 2;

    /// Whether there is room for one more besides `coming` that are not yet sent.
    bool free(std::size_t coming = 0) const { return unshown_.size() + coming < kInFlight; }
    /// The newest revision sent, if any.
    std::optional<std::uint64_t> newest() const { return newest_; }

    void sent(std::uint64_t revision);
    /// There is no picture of this revision for this client; it does without.
    void skipped(std::uint64_t revision) { newest_ = revision; }
    void written(std::uint64_t revision, Clock::time_point now);
    /// The client has presented this revision; earlier ones count as shown too.
    void shown(std::uint64_t revision);

    /// A client that never says what it has shown: pictures written longer ago than `timeout` count as shown.
    void expire(Clock::time_point now, Clock::duration timeout);
    /// When `expire` will next have something to do.
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
