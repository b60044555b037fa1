#pragma once
// How fast one connection may ask.

#include <chrono>

namespace oval4d::net {

/// A bucket that holds two seconds' worth of requests and fills at the allowed rate. Once it is empty requests are
/// refused, and a client that goes on regardless for another two seconds' worth is to be dropped.
class RateLimit {
  public:
    using Clock = std::chrono::steady_clock;
    enum class Verdict { allowed, refused, hopeless };

    RateLimit(double perSecond, Clock::time_point now);

    Verdict take(Clock::time_point now);

  private:
    double perSecond_, burst_, level_;
    Clock::time_point last_;
};

}  // namespace oval4d::net
