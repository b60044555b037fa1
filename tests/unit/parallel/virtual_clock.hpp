#pragma once

#include <atomic>
#include <chrono>
#include <functional>

namespace oval4d::support {

/// A clock for tests. Its time changes only when a test advances the clock. Thread-safe.
class VirtualClock {
  public:
    void advance(std::chrono::nanoseconds by) { sinceEpoch_ += by.count(); }

    /// Returns a function that returns the virtual time, as a time point of `Clock`.
    template <typename Clock>
    std::function<typename Clock::time_point()> now() const {
        return [this] {
            const std::chrono::nanoseconds time(sinceEpoch_);
            return typename Clock::time_point(std::chrono::duration_cast<typename Clock::duration>(time));
        };
    }

  private:
    // Long after time points that are default-constructed.
    static constexpr std::chrono::nanoseconds kStart = std::chrono::hours(1000);
    std::atomic<std::chrono::nanoseconds::rep> sinceEpoch_ = kStart.count();
};

}  // namespace oval4d::support
