#include "net/ws/rate_limit.hpp"

#include <gtest/gtest.h>

namespace oval4d::net {
namespace {

using namespace std::chrono_literals;

TEST(RateLimit, AllowsASteadyRateIndefinitely) {
    RateLimit limit(1000, {});
    for (int i = 1; i < 10'000; ++i) {
        ASSERT_EQ(limit.countRequest(RateLimit::Clock::time_point(i * 1ms)), RateLimit::Verdict::allowed);
    }
}

TEST(RateLimit, AllowsABurstThenRefusesThenReportsAbuse) {
    RateLimit limit(10, {});
    for (int i = 0; i < 20; ++i) ASSERT_EQ(limit.countRequest({}), RateLimit::Verdict::allowed);
    for (int i = 0; i < 20; ++i) ASSERT_EQ(limit.countRequest({}), RateLimit::Verdict::refused);
    EXPECT_EQ(limit.countRequest({}), RateLimit::Verdict::abusive);
}

TEST(RateLimit, RecoversWithTime) {
    RateLimit limit(10, {});
    for (int i = 0; i < 21; ++i) static_cast<void>(limit.countRequest({}));
    EXPECT_EQ(limit.countRequest(RateLimit::Clock::time_point(1s)), RateLimit::Verdict::allowed);
}

}  // namespace
}  // namespace oval4d::net
