#pragma once
// A token bucket for rate limits.

#include <algorithm>
#include <chrono>

namespace oval4d::net {

/// A token bucket for rate limits. It fills at a constant rate, and holds at most `burst` tokens. It may be overdrawn:
/// its level is then negative. Not thread-safe.
class TokenBucket {
  public:
    using Clock = std::chrono::steady_clock;
    using Seconds = std::chrono::duration<double>;

    /// Creates a full bucket. `perSecond` tokens are added per second, up to `burst` tokens.
    TokenBucket(double perSecond, double burst, Clock::time_point now)
        : perSecond_(perSecond), burst_(burst), level_(burst), last_(now) {}

    /// Takes `amount` tokens, even if the bucket holds fewer, and returns the new level.
    double take(double amount, Clock::time_point now) {
        level_ = tokensAt(now) - amount;
        last_ = now;
        return level_;
    }

    /// Returns the number of tokens at `now`; negative if the bucket is overdrawn.
    double tokensAt(Clock::time_point now) const {
        return std::min(burst_, level_ + perSecond_ * std::chrono::duration<double>(now - last_).count());
    }

    bool isFull(Clock::time_point now) const { return tokensAt(now) >= burst_; }

    /// Returns the time until an overdrawn bucket reaches the level 0 again; zero if the bucket is not overdrawn.
    Seconds timeUntilRepaid(Clock::time_point now) const { return Seconds(std::max(0.0, -tokensAt(now) / perSecond_)); }

  private:
    double perSecond_, burst_, level_;
    Clock::time_point last_;
};

}  // namespace oval4d::net
