#pragma once
// The pauses between attempts to use a store that is unavailable.

#include <algorithm>
#include <chrono>
#include <random>

namespace oval4d::store {

/// Exponential backoff with jitter: each pause is a random time from half of a limit to the whole limit. The limit is
/// 0.1 s at first, and doubles after each failure, up to 5 s. Because of the randomness, the servers that share a store
/// do not all retry at the same time.
class Backoff {
  public:
    using Milliseconds = std::chrono::milliseconds;

    Backoff() : random_(std::random_device{}()) {}

    /// Returns the pause after one more failure.
    Milliseconds next() {
        constexpr Milliseconds kFirst{100}, kLongest{5000};
        constexpr int kDoublings = 10;
        const Milliseconds longest = std::min(kFirst * (1 << std::min(failures_++, kDoublings)), kLongest);
        return longest / 2 + Milliseconds(random_() % static_cast<unsigned>(longest.count() / 2));
    }
    /// Makes next() begin again with the shortest pause.
    void reset() { failures_ = 0; }

  private:
    int failures_ = 0;  // number of calls of next() since the last reset()
    std::minstd_rand random_;
};

}  // namespace oval4d::store
