#include "net/live/pacing.hpp"

#include <gtest/gtest.h>

namespace oval4d::net {
namespace {

using namespace std::chrono_literals;

constexpr Pacing::Clock::time_point kStart{};

TEST(Pacing, AllowsTwoUnshownPictures) {
    Pacing pacing;
    EXPECT_FALSE(pacing.newestSentOrSkipped());
    pacing.recordSent(0);
    EXPECT_TRUE(pacing.hasRoom());
    pacing.recordSent(5);
    EXPECT_FALSE(pacing.hasRoom());
    EXPECT_EQ(pacing.newestSentOrSkipped(), 5U);
    pacing.recordShown(0);
    EXPECT_TRUE(pacing.hasRoom());
}

TEST(Pacing, ShownIncludesEarlierRevisions) {
    Pacing pacing;
    pacing.recordSent(3);
    pacing.recordSent(4);
    pacing.recordShown(4);
    pacing.recordSent(5);
    EXPECT_TRUE(pacing.hasRoom());
}

TEST(Pacing, UnwrittenPicturesDoNotExpire) {
    Pacing pacing;
    pacing.recordSent(1);
    pacing.recordSent(2);
    EXPECT_FALSE(pacing.deadline(1s));
    pacing.assumeShown(kStart + 1h, 1s);
    EXPECT_FALSE(pacing.hasRoom());
}

TEST(Pacing, WrittenPicturesExpireInOrder) {
    Pacing pacing;
    pacing.recordSent(1);
    pacing.recordSent(2);
    pacing.recordWritten(1, kStart);
    pacing.recordWritten(2, kStart + 300ms);
    EXPECT_EQ(pacing.deadline(1s), kStart + 1s);
    pacing.assumeShown(kStart + 999ms, 1s);
    EXPECT_FALSE(pacing.hasRoom());
    pacing.assumeShown(kStart + 1s, 1s);
    EXPECT_TRUE(pacing.hasRoom());
    EXPECT_EQ(pacing.deadline(1s), kStart + 1300ms);
}

TEST(Pacing, ASkippedRevisionIsNewestButNotInFlight) {
    Pacing pacing;
    pacing.recordSkipped(7);
    EXPECT_EQ(pacing.newestSentOrSkipped(), 7U);
    pacing.recordSent(8);
    EXPECT_TRUE(pacing.hasRoom());
}

}  // namespace
}  // namespace oval4d::net
