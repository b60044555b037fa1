#pragma once
// Computes the pauses between attempts to use a session store that is unavailable.

#include <algorithm>
#include <chrono>
#include <random>

namespace oval4d::store {

/// An exponential backoff with jitter. Each pause is a random time from half a limit to the limit. The limit is 0.1 s
/// at first, and doubles with each failure, up to 5 s. The random times keep servers that share a store from retrying
/// at the same moment.
class Backoff {
  public:
    using Milliseconds = std::chrono::milliseconds;

    Backoff() : random_(std::random_device{}()) {}

    /// Counts a failure, and returns the pause before the next attempt.
    Milliseconds nextPause() {
        constexpr Milliseconds kFirst{100}, kLongest{5000};
        constexpr int kDoublings = 10;
        const Milliseconds longest = std::min(kFirst * (1 << std::min(failures_++, kDoublings)), kLongest);
        return longest / 2 + Milliseconds(random_() % static_cast<unsigned>(longest.count() / 2));
    }
    /// Resets the count of failures, so that the next pause has the limit 0.1 s again.
    void reset() { failures_ = 0; }

  private:
    int failures_ = 0;  // number of calls of nextPause() since the last reset()
    std::minstd_rand random_;
};

}  // namespace oval4d::store
