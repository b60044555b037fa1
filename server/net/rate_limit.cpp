#include "net/rate_limit.hpp"

#include <algorithm>

namespace oval4d::net {

RateLimit::RateLimit(double perSecond, Clock::time_point now)
    : perSecond_(perSecond), burst_(2 * perSecond), level_(burst_), last_(now) {}

RateLimit::Verdict RateLimit::take(Clock::time_point now) {
    level_ = std::min(burst_, level_ + perSecond_ * std::chrono::duration<double>(now - last_).count()) - 1;
    last_ = now;
    if (level_ >= 0) return Verdict::allowed;
    return level_ >= -burst_ ? Verdict::refused : Verdict::hopeless;
}

}  // namespace oval4d::net
