#pragma once
// Decides when a moving object, or a focus slice that moves to and fro, makes its steps.

#include <algorithm>
#include <chrono>
#include <optional>

namespace oval4d::net {

/// Times the steps of a motion: an object that turns continuously or toward an element, or a focus slice that moves to
/// and fro. Each step covers the time since the previous step.
class MotionTiming {
  public:
    using Clock = std::chrono::steady_clock;
    /// The least time between two steps, and the time that the first step covers.
    static constexpr auto kInterval = std::chrono::duration_cast<Clock::duration>(std::chrono::seconds(1)) / 60;
    /// The longest time that a step covers. This limit prevents large jumps: after a pause, and if a client shows only
    /// one picture per second.
    static constexpr Clock::duration kLongestStep = std::chrono::milliseconds(250);

    /// If a step is due, records that the caller makes it now, and returns the time that the step covers. Returns an
    /// empty optional if no step is due yet.
    std::optional<Clock::duration> stepIfDue(Clock::time_point now) {
        if (last_ && now < nextStepTime()) return std::nullopt;
        const Clock::duration covered = last_ ? std::min(now - *last_, kLongestStep) : kInterval;
        last_ = now;
        return covered;
    }
    /// Returns when the next step is due. A step must have been made since the last stop().
    Clock::time_point nextStepTime() const { return *last_ + kInterval; }
    /// Records that the motion has ended. The next step is then due at once.
    void stop() { last_.reset(); }

  private:
    std::optional<Clock::time_point> last_;  // when the last step was made; empty if nothing moves
};

}  // namespace oval4d::net
