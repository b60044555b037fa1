// The timing of motions and of draft pictures, in virtual time.

#include <gtest/gtest.h>

#include "net/live/draft_timing.hpp"
#include "net/live/motion_timing.hpp"

namespace oval4d::net {
namespace {

using namespace std::chrono_literals;

constexpr MotionTiming::Clock::time_point kOpened{1h};

TEST(MotionTiming, TheFirstStepIsDueAtOnce) {
    MotionTiming timing;
    EXPECT_EQ(timing.stepIfDue(kOpened), MotionTiming::kInterval);
}

TEST(MotionTiming, StepsAreAtLeastAnIntervalApart) {
    MotionTiming timing;
    ASSERT_TRUE(timing.stepIfDue(kOpened));
    EXPECT_FALSE(timing.stepIfDue(kOpened + MotionTiming::kInterval / 2));
    EXPECT_EQ(timing.nextStepTime(), kOpened + MotionTiming::kInterval);
    EXPECT_EQ(timing.stepIfDue(timing.nextStepTime()), MotionTiming::kInterval);
}

// The steps of a motion cover all the time that has passed, whenever the steps are made. An object therefore turns as
// far in each second.
TEST(MotionTiming, StepsCoverTheTimeThatHasPassed) {
    MotionTiming timing;
    ASSERT_TRUE(timing.stepIfDue(kOpened));
    auto now = kOpened;
    MotionTiming::Clock::duration covered{0};
    for (const auto pause : {17ms, 40ms, 5ms, 16ms, 249ms, 100ms, 18ms}) {
        now += pause;
        covered += timing.stepIfDue(now).value_or(0ms);
    }
    EXPECT_EQ(covered, now - kOpened);
}

TEST(MotionTiming, NothingJumpsAfterAPause) {
    MotionTiming timing;
    ASSERT_TRUE(timing.stepIfDue(kOpened));
    EXPECT_EQ(timing.stepIfDue(kOpened + 1h), MotionTiming::kLongestStep);
    timing.stop();
    EXPECT_EQ(timing.stepIfDue(kOpened + 2h), MotionTiming::kInterval);
}

TEST(DraftTiming, OneChangeIsNotQuick) {
    DraftTiming timing(kOpened);
    EXPECT_FALSE(timing.hasQuickChanges());
    timing.recordChange(kOpened + 1ms);
    EXPECT_FALSE(timing.hasQuickChanges());
    EXPECT_EQ(timing.lastChangeTime(), kOpened + 1ms);
}

TEST(DraftTiming, ChangesThatFollowEachOtherAreQuickUntilTheSessionRests) {
    DraftTiming timing(kOpened);
    timing.recordChange(kOpened);
    timing.recordChange(kOpened + 299ms);
    EXPECT_TRUE(timing.hasQuickChanges());
    EXPECT_EQ(timing.quickChangesEndTime(), kOpened + 499ms);
    timing.endQuickChangesIfRested(kOpened + 498ms);
    EXPECT_TRUE(timing.hasQuickChanges());
    timing.endQuickChangesIfRested(kOpened + 499ms);
    EXPECT_FALSE(timing.hasQuickChanges());
}

TEST(DraftTiming, ALaterChangeIsNotQuick) {
    DraftTiming timing(kOpened);
    timing.recordChange(kOpened);
    timing.recordChange(kOpened + 100ms);
    timing.recordChange(kOpened + 400ms);
    EXPECT_FALSE(timing.hasQuickChanges());
}

TEST(DraftTiming, APeriodOfQuickChangesMayBegin) {
    DraftTiming timing(kOpened);
    timing.recordChange(kOpened);
    timing.beginQuickChanges();
    EXPECT_TRUE(timing.hasQuickChanges());
    timing.endQuickChangesIfRested(kOpened + 200ms);
    EXPECT_FALSE(timing.hasQuickChanges());
}

}  // namespace
}  // namespace oval4d::net
