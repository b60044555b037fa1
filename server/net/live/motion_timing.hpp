#pragma once
// When a moving object makes its steps.

#include <algorithm>
#include <chrono>
#include <optional>

namespace oval4d::net {

/// Times the steps of an object that turns continuously or turns toward an element. Each step covers the time since the
/// last one.
class MotionTiming {
  public:
    using Clock = std::chrono::steady_clock;
    /// The least time between two steps. It is also what the first step covers.
    static constexpr auto kInterval = std::chrono::duration_cast<Clock::duration>(std::chrono::seconds(1)) / 60;
    /// The longest time that a step covers. Because of it, the motion continues without a large jump after a pause, and
    /// for a client that shows one picture per second.
    static constexpr Clock::duration kLongestStep = std::chrono::milliseconds(250);

    /// Makes a step if one is due. Returns the time that it covers, or an empty optional if none is due before due().
    std::optional<Clock::duration> step(Clock::time_point now) {
        if (last_ && now < due()) return std::nullopt;
        const Clock::duration covered = last_ ? std::min(now - *last_, kLongestStep) : kInterval;
        last_ = now;
        return covered;
    }
    /// Returns when the next step is due. There must have been one since stop().
    Clock::time_point due() const { return *last_ + kInterval; }
    /// Records that the object does not move.
    void stop() { last_.reset(); }

  private:
    std::optional<Clock::time_point> last_;  // when it made its last step; empty if it does not move
};

}  // namespace oval4d::net
