#pragma once
// A token bucket for rate limits.

#include <algorithm>
#include <chrono>

namespace oval4d::net {

/// A token bucket that fills at a constant rate up to `burst` tokens and may be overdrawn. Not thread-safe.
class TokenBucket {
  public:
    using Clock = std::chrono::steady_clock;
    using Seconds = std::chrono::duration<double>;

    /// Starts full.
    TokenBucket(double perSecond, double burst, Clock::time_point now)
        : perSecond_(perSecond), burst_(burst), level_(burst), last_(now) {}

    /// Takes `amount` tokens and returns the new level; a negative level means that the bucket is overdrawn.
    double take(double amount, Clock::time_point now) {
        level_ = level(now) - amount;
        last_ = now;
        return level_;
    }

    /// The number of tokens at `now`.
    double level(Clock::time_point now) const {
        return std::min(burst_, level_ + perSecond_ * std::chrono::duration<double>(now - last_).count());
    }

    bool full(Clock::time_point now) const { return level(now) >= burst_; }

    /// The time until the level is 0 again; zero if the bucket is not overdrawn.
    Seconds debt(Clock::time_point now) const { return Seconds(std::max(0.0, -level(now) / perSecond_)); }

  private:
    double perSecond_, burst_, level_;
    Clock::time_point last_;
};

}  // namespace oval4d::net
