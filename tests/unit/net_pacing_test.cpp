#include "net/pacing.hpp"

#include <gtest/gtest.h>

#include "net/rate_limit.hpp"

namespace oval4d::net {
namespace {

using namespace std::chrono_literals;

constexpr Pacing::Clock::time_point kStart{};

TEST(Pacing, TwoPicturesMayBeUnshown) {
    Pacing pacing;
    EXPECT_FALSE(pacing.newest());
    pacing.sent(0);
    EXPECT_TRUE(pacing.free());
    pacing.sent(5);
    EXPECT_FALSE(pacing.free());
    EXPECT_EQ(pacing.newest(), 5U);
    pacing.shown(0);
    EXPECT_TRUE(pacing.free());
}

TEST(Pacing, ShownCoversWhatCameBefore) {
    Pacing pacing;
    pacing.sent(3);
    pacing.sent(4);
    pacing.shown(4);
    pacing.sent(5);
    EXPECT_TRUE(pacing.free());
}

TEST(Pacing, WhatWasNotWrittenDoesNotExpire) {
    Pacing pacing;
    pacing.sent(1);
    pacing.sent(2);
    EXPECT_FALSE(pacing.deadline(1s));
    pacing.expire(kStart + 1h, 1s);
    EXPECT_FALSE(pacing.free());
}

TEST(Pacing, WrittenPicturesExpireOneAfterTheOther) {
    Pacing pacing;
    pacing.sent(1);
    pacing.sent(2);
    pacing.written(1, kStart);
    pacing.written(2, kStart + 300ms);
    EXPECT_EQ(pacing.deadline(1s), kStart + 1s);
    pacing.expire(kStart + 999ms, 1s);
    EXPECT_FALSE(pacing.free());
    pacing.expire(kStart + 1s, 1s);
    EXPECT_TRUE(pacing.free());
    EXPECT_EQ(pacing.deadline(1s), kStart + 1300ms);
}

TEST(Pacing, ASkippedRevisionIsHadButNotInFlight) {
    Pacing pacing;
    pacing.skipped(7);
    EXPECT_EQ(pacing.newest(), 7U);
    pacing.sent(8);
    EXPECT_TRUE(pacing.free());
}

TEST(RateLimit, LetsTheRateThroughForEver) {
    RateLimit limit(1000, {});
    for (int i = 1; i < 10'000; ++i) {
        ASSERT_EQ(limit.take(RateLimit::Clock::time_point(i * 1ms)), RateLimit::Verdict::allowed);
    }
}

TEST(RateLimit, LetsABurstThroughThenRefusesThenGivesUp) {
    RateLimit limit(10, {});
    for (int i = 0; i < 20; ++i) ASSERT_EQ(limit.take({}), RateLimit::Verdict::allowed);
    for (int i = 0; i < 20; ++i) ASSERT_EQ(limit.take({}), RateLimit::Verdict::refused);
    EXPECT_EQ(limit.take({}), RateLimit::Verdict::hopeless);
}

TEST(RateLimit, ForgivesWithTime) {
    RateLimit limit(10, {});
    for (int i = 0; i < 21; ++i) static_cast<void>(limit.take({}));
    EXPECT_EQ(limit.take(RateLimit::Clock::time_point(1s)), RateLimit::Verdict::allowed);
}

}  // namespace
}  // namespace oval4d::net
