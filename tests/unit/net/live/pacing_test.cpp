#include "net/live/pacing.hpp"

#include <gtest/gtest.h>

namespace oval4d::net {
namespace {

using namespace std::chrono_literals;

constexpr PicturePacing::Clock::time_point kStart{};

TEST(PicturePacing, AllowsTwoUnshownPictures) {
    PicturePacing pacing;
    EXPECT_FALSE(pacing.newestRevisionSentOrSkipped());
    pacing.recordSent(0);
    EXPECT_TRUE(pacing.maySendMore());
    pacing.recordSent(5);
    EXPECT_FALSE(pacing.maySendMore());
    EXPECT_EQ(pacing.newestRevisionSentOrSkipped(), 5U);
    pacing.recordShown(0);
    EXPECT_TRUE(pacing.maySendMore());
}

TEST(PicturePacing, ShownIncludesEarlierRevisions) {
    PicturePacing pacing;
    pacing.recordSent(3);
    pacing.recordSent(4);
    pacing.recordShown(4);
    pacing.recordSent(5);
    EXPECT_TRUE(pacing.maySendMore());
}

TEST(PicturePacing, UnwrittenPicturesDoNotExpire) {
    PicturePacing pacing;
    pacing.recordSent(1);
    pacing.recordSent(2);
    EXPECT_FALSE(pacing.assumeShownTime(1s));
    pacing.assumeShown(kStart + 1h, 1s);
    EXPECT_FALSE(pacing.maySendMore());
}

TEST(PicturePacing, WrittenPicturesExpireInOrder) {
    PicturePacing pacing;
    pacing.recordSent(1);
    pacing.recordSent(2);
    pacing.recordWritten(1, kStart);
    pacing.recordWritten(2, kStart + 300ms);
    EXPECT_EQ(pacing.assumeShownTime(1s), kStart + 1s);
    pacing.assumeShown(kStart + 999ms, 1s);
    EXPECT_FALSE(pacing.maySendMore());
    pacing.assumeShown(kStart + 1s, 1s);
    EXPECT_TRUE(pacing.maySendMore());
    EXPECT_EQ(pacing.assumeShownTime(1s), kStart + 1300ms);
}

TEST(PicturePacing, ASkippedRevisionIsNewestButNotInFlight) {
    PicturePacing pacing;
    pacing.recordSkipped(7);
    EXPECT_EQ(pacing.newestRevisionSentOrSkipped(), 7U);
    pacing.recordSent(8);
    EXPECT_TRUE(pacing.maySendMore());
}

}  // namespace
}  // namespace oval4d::net
