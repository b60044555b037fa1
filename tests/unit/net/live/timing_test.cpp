// Motion and drafts, in times that the tests choose.

#include <gtest/gtest.h>

#include "net/live/draft_timing.hpp"
#include "net/live/motion_timing.hpp"

namespace oval4d::net {
namespace {

using namespace std::chrono_literals;

constexpr MotionTiming::Clock::time_point kStart{1h};

TEST(MotionTiming, TheFirstStepIsDueAtOnce) {
    MotionTiming timing;
    EXPECT_EQ(timing.step(kStart), MotionTiming::kInterval);
}

TEST(MotionTiming, StepsAreAtLeastAnIntervalApart) {
    MotionTiming timing;
    ASSERT_TRUE(timing.step(kStart));
    EXPECT_FALSE(timing.step(kStart + MotionTiming::kInterval / 2));
    EXPECT_EQ(timing.due(), kStart + MotionTiming::kInterval);
    EXPECT_EQ(timing.step(timing.due()), MotionTiming::kInterval);
}

// Whatever the times of the steps are, an object turns as far in a second as the second is long.
TEST(MotionTiming, StepsCoverTheTimeThatHasPassed) {
    MotionTiming timing;
    ASSERT_TRUE(timing.step(kStart));
    auto now = kStart;
    MotionTiming::Clock::duration covered{0};
    for (const auto pause : {17ms, 40ms, 5ms, 16ms, 249ms, 100ms, 18ms}) {
        now += pause;
        covered += timing.step(now).value_or(0ms);
    }
    EXPECT_EQ(covered, now - kStart);
}

TEST(MotionTiming, NothingJumpsAfterAPause) {
    MotionTiming timing;
    ASSERT_TRUE(timing.step(kStart));
    EXPECT_EQ(timing.step(kStart + 1h), MotionTiming::kLongestStep);
    timing.stop();
    EXPECT_EQ(timing.step(kStart + 2h), MotionTiming::kInterval);
}

TEST(DraftTiming, OneChangeIsNotQuick) {
    DraftTiming timing(kStart);
    EXPECT_FALSE(timing.isQuick());
    timing.change(kStart + 1ms);
    EXPECT_FALSE(timing.isQuick());
    EXPECT_EQ(timing.changed(), kStart + 1ms);
}

TEST(DraftTiming, ChangesThatFollowEachOtherAreQuickUntilTheSessionRests) {
    DraftTiming timing(kStart);
    timing.change(kStart);
    timing.change(kStart + 299ms);
    EXPECT_TRUE(timing.isQuick());
    EXPECT_EQ(timing.restEnds(), kStart + 499ms);
    timing.rest(kStart + 498ms);
    EXPECT_TRUE(timing.isQuick());
    timing.rest(kStart + 499ms);
    EXPECT_FALSE(timing.isQuick());
}

TEST(DraftTiming, ALaterChangeIsNotQuick) {
    DraftTiming timing(kStart);
    timing.change(kStart);
    timing.change(kStart + 100ms);
    timing.change(kStart + 400ms);
    EXPECT_FALSE(timing.isQuick());
}

TEST(DraftTiming, APeriodOfQuickChangesMayBegin) {
    DraftTiming timing(kStart);
    timing.change(kStart);
    timing.begin();
    EXPECT_TRUE(timing.isQuick());
    timing.rest(kStart + 200ms);
    EXPECT_FALSE(timing.isQuick());
}

}  // namespace
}  // namespace oval4d::net
