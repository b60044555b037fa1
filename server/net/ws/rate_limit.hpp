#pragma once
// The limit on the rate of requests over one connection.

#include "net/token_bucket.hpp"

namespace oval4d::net {

/// Limits the rate of requests of a client. A burst may have as many requests as the rate allows in two seconds.
/// Further requests are refused, but still count. A client that continues until the refused requests make up another
/// such burst is abusive, and should be disconnected. Not thread-safe.
class RateLimit {
  public:
    using Clock = TokenBucket::Clock;
    enum class Verdict { allowed, refused, abusive };

    /// `perSecond` is the number of requests allowed per second.
    RateLimit(double perSecond, Clock::time_point now)
        : bucket_(perSecond, 2 * perSecond, now), abusive_(-2 * perSecond) {}

    /// Counts a request, and decides whether it is allowed.
    Verdict countRequest(Clock::time_point now) {
        const double left = bucket_.take(1, now);
        return left >= 0 ? Verdict::allowed : left >= abusive_ ? Verdict::refused : Verdict::abusive;
    }

  private:
    TokenBucket bucket_;
    double abusive_;  // the level of bucket_ below which a client is abusive
};

}  // namespace oval4d::net
