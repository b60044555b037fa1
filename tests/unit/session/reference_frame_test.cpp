#include <cmath>

#include <gtest/gtest.h>

#include "fields/field.hpp"
#include "session/history.hpp"
#include "session/settings.hpp"
#include "unit/session/support.hpp"

namespace oval4d::session {
namespace {

double radiusOf(const Session& session) { return infoOf(session.current).circumradius; }

TEST(ReferenceFrames, CommandsAndSettingsChangeThem) {
    Session session;
    line(session, ":set pace=2");
    EXPECT_EQ(session.current.referenceFrame.pace, 2);
    line(session, "follow 0.3,0,-1/2");
    EXPECT_EQ(session.current.referenceFrame.follow, glm::dvec3(0.3, 0, -0.5));
    line(session, "boost y 0.6");
    EXPECT_EQ(session.current.referenceFrame.boost, glm::dvec3(0, 0.6, 0));
    line(session, "boost x -sqrt(0.5)");
    EXPECT_EQ(session.current.referenceFrame.boost, glm::dvec3(-std::sqrt(0.5), 0, 0)) << "it replaces the former one";
    line(session, "boost 0.1,0.2,0.3");
    EXPECT_EQ(session.current.referenceFrame.boost, glm::dvec3(0.1, 0.2, 0.3));
    for (const char* spaced : {"boost 0.3, 0.2,0.1", "boost 0.3,0.2 ,0.1", "boost 0.3, 0.2, 0.1"}) {
        line(session, "boost none");
        line(session, spaced);
        EXPECT_EQ(session.current.referenceFrame.boost, glm::dvec3(0.3, 0.2, 0.1)) << spaced;
    }
    line(session, "set boost=none follow=none pace=1");
    EXPECT_EQ(session.current.referenceFrame, geometry::ReferenceFrame{});
    EXPECT_EQ(session.current.object, session.current.source);
}

TEST(ReferenceFrames, ValuesOutOfRangeAreRefused) {
    Session session;
    line(session, "boost x 0.5");
    const auto refused = [&](const char* text, ErrorCode code, const char* says) {
        SCOPED_TRACE(text);
        expectRefused(session, CommandLine{text}, code, says);
    };
    refused("set pace=0", ErrorCode::out_of_range, "the pace must be from 0.001 to 1000, not 0");
    refused("set pace=-1", ErrorCode::out_of_range, "the pace must be from 0.001 to 1000");
    refused("set pace=1e4", ErrorCode::out_of_range, "from 0.001 to 1000");
    refused("follow 0,2000,0", ErrorCode::out_of_range, "the velocity to follow along y must be from −1000 to 1000");
    refused("boost x 1", ErrorCode::out_of_range, "must be from 0 to 0.999, where 1 is the speed of light, not 1");
    refused("boost 0.8,0.8,0", ErrorCode::out_of_range, "from 0 to 0.999");
    refused("boost w 0.5", ErrorCode::bad_expression, "an axis x, y or z");
    refused("boost xy 0.5", ErrorCode::bad_expression, "an axis x, y or z");
    refused("boost 0.5", ErrorCode::bad_expression, "none or a velocity x,y,z");
    refused("boost", ErrorCode::bad_expression, "none or a velocity x,y,z");
    refused("follow 1,2,3,4", ErrorCode::bad_expression, "none or a velocity x,y,z");
    refused("follow 1,,2", ErrorCode::bad_expression, "follow: ");
    refused("boost x fast", ErrorCode::bad_expression, "boost: ");
}

TEST(ReferenceFrames, ApplyBeforeTheOrientationToTheObjectItself) {
    Session session;
    line(session, "polytope 8-cell");
    press(session, "y");
    line(session, "set boost=0.6,0,0 pace=3");
    const auto& shown = *std::get<slicing::PolytopePtr>(session.current.object);
    const auto& own = *std::get<slicing::PolytopePtr>(session.current.source);
    const glm::dmat4 matrix = session.current.referenceFrame.matrix();
    for (std::size_t v = 0; v < own.vertices.size(); ++v)
        EXPECT_LT(glm::distance(shown.vertices[v], matrix * own.vertices[v]), 1e-12);
    line(session, "boost x 0.3");
    const auto& next = *std::get<slicing::PolytopePtr>(session.current.object);
    EXPECT_LT(glm::distance(next.vertices[5], session.current.referenceFrame.matrix() * own.vertices[5]), 1e-12)
        << "the image of the object, not of its image";
}

TEST(ReferenceFrames, KeepTheSpacingOfThinFieldsWithinItsBounds) {
    Session session;
    LoadObject load{"thin", "formula", "x+y+z+w"};
    load.box = fields::Box{{-1, -1, -1, -1e-4}, {1, 1, 1, 1e-4}};
    must(session, load);
    EXPECT_LT(session.current.slices.spacing, 1e-5);
    line(session, "set pace=0.01");
    EXPECT_EQ(session.current.slices.spacing, kMinSpacing * radiusOf(session));
}

TEST(ReferenceFrames, AreUndoneAndRedone) {
    Session session;
    const State before = session.current;
    line(session, "boost x 0.6");
    const State after = session.current;
    press(session, "u");
    EXPECT_EQ(session.current, before);
    must(session, Redo{});
    EXPECT_EQ(session.current, after);
    EXPECT_EQ(session.current.object, after.object) << "the image is not made again";
    const auto revision = session.revision;
    line(session, "boost x 0.6");
    EXPECT_EQ(session.revision, revision) << "nothing has changed";
}

TEST(ReferenceFrames, AreKeptWhenTheObjectChanges) {
    Session session;
    line(session, "set pace=2 boost=0.6,0,0");
    line(session, "polytope 24-cell");
    EXPECT_EQ(session.current.referenceFrame, (geometry::ReferenceFrame{2, {}, {0.6, 0, 0}}));
    EXPECT_NE(session.current.object, session.current.source);
    EXPECT_EQ(infoOf(session.current).name, "24-cell");
    press(session, "n");
    EXPECT_EQ(infoOf(session.current).name, "120-cell") << "the image has its place in the catalogue";
    press(session, "N");
    EXPECT_EQ(infoOf(session.current).name, "24-cell");
    const auto revision = session.revision;
    line(session, "polytope 24-cell");
    EXPECT_EQ(session.revision, revision);
    line(session, "reset");
    EXPECT_EQ(session.current.referenceFrame.pace, 2);
    line(session, "formula x^2+y^2+z^2 < 0.1 + w^2");
    EXPECT_NE(session.current.object, session.current.source);
    LoadObject edited{"formula", "formula", "x^2+y^2+z^2 < 0.2 + w^2"};
    edited.continues = true;
    line(session, "set levels=0,1 spacing=0.2 focus=2");
    must(session, edited);
    EXPECT_EQ(session.current.referenceFrame.pace, 2);
    EXPECT_EQ(session.current.slices.focus, 2) << "the box is as large as before";
    EXPECT_EQ(session.current.look.field.levels, (std::vector<double>{0, 1}));
}

TEST(ReferenceFrames, ASpanThatNobodyHasChangedFollowsTheCircumradius) {
    Session session;
    line(session, "polytope 8-cell");
    line(session, "set w=0.6");
    line(session, "set pace=3");
    EXPECT_DOUBLE_EQ(radiusOf(session), std::sqrt(12.0));
    EXPECT_DOUBLE_EQ(session.current.slices.spacing, 2 * std::sqrt(12.0) / 20);
    EXPECT_NEAR(session.current.focusW(), 0.6, 1e-12);
    line(session, "set pace=1");
    EXPECT_DOUBLE_EQ(session.current.slices.spacing, 0.2);
    line(session, "set spacing=0.15 focus=4");
    for (const char* frame : {"set pace=5", "boost z 0.9", "follow 1,1,1", "set pace=0.1"}) {
        line(session, frame);
        EXPECT_EQ(session.current.slices.spacing, 0.15) << frame;
        EXPECT_EQ(session.current.slices.focus, 4) << frame;
    }
}

TEST(ReferenceFrames, LengthsStayWithinTheirBounds) {
    Session session;
    line(session, "polytope 8-cell");
    line(session, "set pace=1000");
    line(session, "set spacing=9000 offset=9000 point=9000,0,0,0");
    line(session, "set pace=0.001");
    const double radius = radiusOf(session);
    EXPECT_LT(radius, 2);
    EXPECT_LE(session.current.slices.spacing, kMaxSpacing * radius);
    EXPECT_LE(std::abs(session.current.slices.offset), kMaxOffset * radius);
    EXPECT_LE(session.current.look.focusPoint.x, kMaxOffset * radius);
}

TEST(ReferenceFrames, EndATurnTowardAnElement) {
    Session session;
    line(session, "toward cell");
    EXPECT_TRUE(session.current.isMoving());
    line(session, "boost x 0.1");
    EXPECT_FALSE(session.current.isMoving());
}

TEST(ReferenceFrames, QueriesApplyThemBeforeTheSlices) {
    const auto state = stateFromQuery({{"polytope", "8-cell"}, {"pace", "2"}, {"follow", "0.5,0,0"}, {"w", "15"}});
    ASSERT_TRUE(state) << state.error().message;
    EXPECT_EQ(state->referenceFrame, (geometry::ReferenceFrame{2, {0.5, 0, 0}, {}}));
    EXPECT_NEAR(state->slices.spacing, spanningSpacing(state->object, 21), 1e-12);
    EXPECT_NEAR(state->focusW(), 15, 1e-12) << "within ten circumradii of the image";
    EXPECT_FALSE(stateFromQuery({{"boost", "1,0,0"}}));
}

TEST(ReferenceFrames, ImagesOfLargeObjectsAreDeferred) {
    Session session;
    line(session, "set pace=2");
    for (const char* name : {"120-cell", "24-cell"}) (void)support::shared(name);  // put the polytope into the cache
    const Session before = session;
    ObjectLoader loader(Limits{}, support::cache(), ObjectLoader::LoadingMode::deferred, readObject);
    const CommandLine both{"set polytope=120-cell boost=0.5,0,0"};
    ComputedOutcome outcome;
    int images = 0;
    for (; needsLoading(session, both, Limits{}, loader, outcome) && images < 5; ++images) {
        EXPECT_EQ(session, before);
        EXPECT_FALSE(loader.pendingNeedsFile());
        EXPECT_GT(loader.estimatedMemory(), slicing::memoryOf(support::shared("120-cell")));
        ObjectLoader moved = std::move(loader);  // a server also moves the loader to another thread and back
        moved.completePending();
        loader = std::move(moved);
    }
    const auto done = session::apply(session, both, Limits{}, loader);
    ASSERT_TRUE(done) << done.error().message;
    EXPECT_EQ(images, 2) << "in the old frame and in the new one";
    EXPECT_EQ(infoOf(session.current).name, "120-cell");
    EXPECT_EQ(session.current.referenceFrame, (geometry::ReferenceFrame{2, {}, {0.5, 0, 0}}));
    ObjectLoader other(Limits{}, support::cache(), ObjectLoader::LoadingMode::deferred, readObject);
    const CommandLine small{"polytope 24-cell"};
    EXPECT_FALSE(needsLoading(session, small, Limits{}, other, outcome)) << "small images are made at once";
    const auto image = other.transformedTo(support::shared("24-cell"), session.current.referenceFrame);
    ASSERT_TRUE(image);
    ASSERT_TRUE(session::apply(session, small, Limits{}, other));
    EXPECT_EQ(session.current.object, *image) << "and only once";
}

TEST(ReferenceFrames, ImagesAreCountedAndLimited) {
    Session session;
    line(session, "polytope 24-cell");
    EXPECT_EQ(unsharedMemoryOfObjects(session), 0U) << "all sessions share the catalogue";
    line(session, "boost x 0.1");
    const std::size_t one = slicing::memoryOf(session.current.object);
    EXPECT_EQ(unsharedMemoryOfObjects(session), one);
    line(session, "boost x 0.2");
    EXPECT_EQ(unsharedMemoryOfObjects(session), 2 * one);
    const Limits limits{.maxUndoBytes = 5 * one};
    for (int i = 0; i < 20; ++i) must(session, CommandLine{"boost y " + std::to_string(0.01 * (i + 1))}, limits);
    EXPECT_LE(unsharedMemoryOfObjects(session), 6 * one);
    EXPECT_GE(session.undoSteps.size(), 4U);
    EXPECT_LE(session.undoSteps.size(), 6U);
}

}  // namespace
}  // namespace oval4d::session
