#pragma once
// The rate limit for the requests of one connection.

#include "net/token_bucket.hpp"

namespace oval4d::net {

/// Allows bursts of up to two seconds' worth of requests, then refuses requests. A client that sends another two
/// seconds' worth of refused requests is abusive and should be disconnected. Not thread-safe.
class RateLimit {
  public:
    using Clock = TokenBucket::Clock;
    enum class Verdict { allowed, refused, abusive };

    RateLimit(double perSecond, Clock::time_point now)
        : bucket_(perSecond, 2 * perSecond, now), abusive_(-2 * perSecond) {}

    /// Counts a request and decides whether it is allowed.
    Verdict take(Clock::time_point now) {
        const double left = bucket_.take(1, now);
        return left >= 0 ? Verdict::allowed : left >= abusive_ ? Verdict::refused : Verdict::abusive;
    }

  private:
    TokenBucket bucket_;
    double abusive_;
};

}  // namespace oval4d::net
