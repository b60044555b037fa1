// Which pictures of a session are kept, and which are being made.

#include <memory>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "net/live/picture_jobs.hpp"
#include "net/live/snapshot_picture_cache.hpp"

namespace oval4d::net {
namespace {

using slicing::Quality;

const PictureStreamKey kFrames{wire::StreamKind::frames, {}, {640, 480}};
const PictureStreamKey kGeometry{wire::StreamKind::geometry, {}, {640, 480}};

SessionSnapshotPtr snapshotOf(std::uint64_t revision, Quality quality = Quality::full) {
    auto snapshot = std::make_shared<SessionSnapshot>();
    snapshot->revision = revision;
    snapshot->quality = quality;
    return snapshot;
}

SnapshotPictureCache::MessagesByStream pictureOf(const PictureStreamKey& key, const std::string& text) {
    return {{key, textMessage(text)}};
}

TEST(SessionSnapshot, MakesOneTextOfTheStateForEachScheme) {
    const SessionSnapshotPtr snapshot =
        makeStateSnapshot(session::initialState(), 7, {}, {0, {}, 0, {"cuboctahedron", "point"}});
    const SharedBytes dark = snapshot->stateTextFor(scene::ColorScheme::dark);
    const SharedBytes light = snapshot->stateTextFor(scene::ColorScheme::light);
    EXPECT_NE(dark.view().find("\"revision\":7,"), std::string_view::npos) << dark.view();
    EXPECT_NE(dark.view().find("cuboctahedron"), std::string_view::npos) << dark.view();
    EXPECT_NE(dark.view(), light.view()) << "their colors of cells differ";
    EXPECT_EQ(snapshot->stateTextFor(scene::ColorScheme::dark).view().data(), dark.view().data());
    EXPECT_EQ(snapshot->stateTextFor(scene::ColorScheme::light, {}).view().data(), light.view().data());
    const SharedBytes answer = snapshot->stateTextFor(scene::ColorScheme::dark, 3);
    EXPECT_NE(answer.view().find("\"id\":3,"), std::string_view::npos) << answer.view();
    EXPECT_FALSE(snapshot->sliced);
    EXPECT_EQ(snapshot->quality, Quality::full);
}

TEST(SnapshotPictureCache, FindsPicturesByKindRevisionAndQuality) {
    SnapshotPictureCache pictures;
    EXPECT_EQ(pictures.find(kFrames, 0, Quality::draft), nullptr);
    const SessionSnapshotPtr draft = snapshotOf(3, Quality::draft);
    pictures.addUnlessOlder(draft, pictureOf(kFrames, "frame"));
    pictures.addUnlessOlder(draft, pictureOf(kGeometry, "slices"));
    EXPECT_NE(pictures.find(kFrames, 3, Quality::draft), nullptr);
    EXPECT_NE(pictures.find(kGeometry, 3, Quality::draft), nullptr);
    EXPECT_EQ(pictures.find(kFrames, 3, Quality::full), nullptr);
    EXPECT_EQ(pictures.find(kFrames, 2, Quality::draft), nullptr);
    EXPECT_EQ(pictures.findSnapshot(3, Quality::draft), draft);
    EXPECT_EQ(pictures.findSnapshot(3, Quality::full), nullptr);
}

TEST(SnapshotPictureCache, ReplacesOlderPicturesByNewerOnes) {
    SnapshotPictureCache pictures;
    pictures.addUnlessOlder(snapshotOf(3), pictureOf(kFrames, "3"));
    pictures.addUnlessOlder(snapshotOf(4, Quality::draft), pictureOf(kGeometry, "4"));
    EXPECT_EQ(pictures.find(kFrames, 3, Quality::draft), nullptr);
    pictures.addUnlessOlder(snapshotOf(3), pictureOf(kFrames, "3"));  // the result of a slower worker
    EXPECT_EQ(pictures.find(kFrames, 3, Quality::draft), nullptr);
    EXPECT_NE(pictures.find(kGeometry, 4, Quality::draft), nullptr);
    pictures.addUnlessOlder(snapshotOf(4, Quality::full), {});
    EXPECT_EQ(pictures.find(kGeometry, 4, Quality::draft), nullptr);
    pictures.addUnlessOlder(nullptr, {});  // the result of a job that made no pictures
    EXPECT_NE(pictures.snapshot(), nullptr);
    pictures.clear();
    EXPECT_EQ(pictures.snapshot(), nullptr);
}

TEST(PictureJobs, TheNextJobMayBeginOnceThePictureIsDrawn) {
    PictureJobs inProgress;
    EXPECT_FALSE(inProgress.isQueuedOrDrawing());
    EXPECT_EQ(inProgress.currentOrNextJobNumber(), 1U);
    inProgress.recordQueued();
    EXPECT_TRUE(inProgress.isQueuedOrDrawing());
    EXPECT_EQ(inProgress.currentOrNextJobNumber(), 1U);
    inProgress.recordLastPictureDrawn({1, 7, Quality::full, kFrames});
    EXPECT_FALSE(inProgress.isQueuedOrDrawing());
    EXPECT_TRUE(inProgress.isEncoding(kFrames, 7, Quality::draft));
    EXPECT_FALSE(inProgress.isEncoding(kFrames, 6, Quality::draft));
    EXPECT_FALSE(inProgress.isEncoding(kGeometry, 7, Quality::draft));
    EXPECT_EQ(inProgress.currentOrNextJobNumber(), 2U);
    inProgress.recordQueued();
    inProgress.recordLastPictureDrawn({2, 8, Quality::draft, kFrames});
    EXPECT_EQ(inProgress.countEncoding(kFrames), 2U);
    EXPECT_FALSE(inProgress.isEncoding(kFrames, 8, Quality::full));
    inProgress.recordDone(1);
    EXPECT_EQ(inProgress.countEncoding(kFrames), 1U);
    EXPECT_FALSE(inProgress.isEncoding(kFrames, 7, Quality::draft));
}

TEST(PictureJobs, AJobWithoutAFrameEndsAtOnce) {
    PictureJobs inProgress;
    inProgress.recordQueued();
    inProgress.recordDone(1);
    EXPECT_FALSE(inProgress.isQueuedOrDrawing());
    EXPECT_EQ(inProgress.currentOrNextJobNumber(), 2U);
}

}  // namespace
}  // namespace oval4d::net
