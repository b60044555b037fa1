#include "net/live/pacing.hpp"

#include <gtest/gtest.h>

namespace oval4d::net {
namespace {

using namespace std::chrono_literals;

constexpr Pacing::Clock::time_point kStart{};

TEST(Pacing, AllowsTwoUnshownPictures) {
    Pacing pacing;
    EXPECT_FALSE(pacing.newest());
    pacing.sent(0);
    EXPECT_TRUE(pacing.hasRoom());
    pacing.sent(5);
    EXPECT_FALSE(pacing.hasRoom());
    EXPECT_EQ(pacing.newest(), 5U);
    pacing.shown(0);
    EXPECT_TRUE(pacing.hasRoom());
}

TEST(Pacing, ShownIncludesEarlierRevisions) {
    Pacing pacing;
    pacing.sent(3);
    pacing.sent(4);
    pacing.shown(4);
    pacing.sent(5);
    EXPECT_TRUE(pacing.hasRoom());
}

TEST(Pacing, UnwrittenPicturesDoNotExpire) {
    Pacing pacing;
    pacing.sent(1);
    pacing.sent(2);
    EXPECT_FALSE(pacing.deadline(1s));
    pacing.assumeShown(kStart + 1h, 1s);
    EXPECT_FALSE(pacing.hasRoom());
}

TEST(Pacing, WrittenPicturesExpireInOrder) {
    Pacing pacing;
    pacing.sent(1);
    pacing.sent(2);
    pacing.written(1, kStart);
    pacing.written(2, kStart + 300ms);
    EXPECT_EQ(pacing.deadline(1s), kStart + 1s);
    pacing.assumeShown(kStart + 999ms, 1s);
    EXPECT_FALSE(pacing.hasRoom());
    pacing.assumeShown(kStart + 1s, 1s);
    EXPECT_TRUE(pacing.hasRoom());
    EXPECT_EQ(pacing.deadline(1s), kStart + 1300ms);
}

TEST(Pacing, ASkippedRevisionIsNewestButNotInFlight) {
    Pacing pacing;
    pacing.skipped(7);
    EXPECT_EQ(pacing.newest(), 7U);
    pacing.sent(8);
    EXPECT_TRUE(pacing.hasRoom());
}

}  // namespace
}  // namespace oval4d::net
