// Tests of turning elements toward +w, and of moving the focus from vertex to vertex.

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "session/settings.hpp"
#include "unit/session/support.hpp"

namespace oval4d::session {
namespace {

using slicing::ElementKind;

double topOf(const State& state) { return slicing::rangeOfW(state.object, state.orientation).second; }

// Lets all motion end, in steps of 1/60 s. Returns its duration in seconds.
double finish(Session& session) {
    double seconds = 0;
    for (; session.current.isMoving() && seconds < 10; seconds += 1.0 / 60) advanceMotionBy(session, 1.0 / 60);
    return seconds;
}

TEST(TurnToward, MovesAlongTheShortestWayAtConstantSpeed) {
    Session session;
    line(session, "polytope tesseract");
    press(session, "ryt");
    const geometry::Rotation start = session.current.orientation;
    must(session, TurnToward{ElementKind::cell, 3});
    EXPECT_EQ(session.current.orientation, start) << "it moves, and does not jump";
    ASSERT_TRUE(session.current.ongoingTurnToward);
    const geometry::Rotation goal = session.current.ongoingTurnToward->goal;
    const double angle = (goal * start.inverse()).largerAngle();
    EXPECT_NEAR(session.current.ongoingTurnToward->seconds, angle / (std::numbers::pi / 2), 1e-9);
    double before = angle;
    while (session.current.isMoving()) {
        advanceMotionBy(session, 1.0 / 60);
        const double left = (goal * session.current.orientation.inverse()).largerAngle();
        EXPECT_NEAR(before - left, std::min(before, std::numbers::pi / 120), 1e-6);
        before = left;
    }
    EXPECT_EQ(session.current.orientation, goal);
    EXPECT_NEAR(topOf(session.current), 1, 1e-12) << "a cell of the tesseract with edge 2 is at w = 1";
    const std::uint64_t revision = session.revision;
    advanceMotionBy(session, 1);
    EXPECT_EQ(session.revision, revision) << "the motion has ended";
}

TEST(TurnToward, IsOneUndoStep) {
    Session session;
    line(session, "polytope 24-cell");
    press(session, "r");
    const State before = session.current;
    press(session, "zv");
    finish(session);
    const State after = session.current;
    EXPECT_NEAR(topOf(after), slicing::infoOf(after.object).circumradius, 1e-9);
    press(session, "u");
    EXPECT_EQ(session.current, before);
    must(session, Redo{});
    EXPECT_EQ(session.current, after);
}

TEST(TurnToward, EndsWhenTheObjectIsTurnedOtherwise) {
    for (const char* command : {"rotate xy 10deg", "polytope 5-cell", "reset", "undo"}) {
        Session session;
        line(session, "polytope tesseract");
        press(session, "r");
        line(session, "toward vertex 2");
        advanceMotionBy(session, 0.1);
        ASSERT_TRUE(session.current.ongoingTurnToward);
        line(session, command);
        EXPECT_FALSE(session.current.isMoving()) << command;
    }
    Session session;
    press(session, "r ");
    ASSERT_TRUE(session.current.turning);
    press(session, "ze");
    EXPECT_FALSE(session.current.turning);
    press(session, " ");
    EXPECT_TRUE(session.current.turning && !session.current.ongoingTurnToward);
}

TEST(TurnToward, RefusesElementsThatDoNotExist) {
    Session session;
    line(session, "polytope tesseract");
    expectRefused(session, CommandLine{"toward cell 8"}, ErrorCode::out_of_range,
                  "the number of the cell must be from 0 to 7 for the 8-cell, not 8");
    expectRefused(session, CommandLine{"toward corner"}, ErrorCode::bad_expression,
                  "an element is vertex, edge, face or cell, not 'corner'");
    expectRefused(session, CommandLine{"toward"}, ErrorCode::bad_expression, "such as toward cell 3");
    expectRefused(session, CommandLine{"toward cell x"}, ErrorCode::bad_expression, "a whole number from 0, not 'x'");
    expectRefused(session, CommandLine{"toward cell 1 2"}, ErrorCode::bad_expression, "not 'cell 1 2'");
    must(session, LoadObject{"points", "cloud", "1 0 0 0\n0 1 0 0\n"});
    expectRefused(session, CommandLine{"toward edge"}, ErrorCode::out_of_range, "has no edge");
    line(session, "toward vertex 1");
    finish(session);
    EXPECT_NEAR(topOf(session.current), 1, 1e-12);
}

TEST(TurnToward, IsImmediateInQueries) {
    const auto state = stateFromQuery({{"toward", "cell:2"}, {"polytope", "tesseract"}, {"rotate", "xw:0.3"}});
    ASSERT_TRUE(state) << state.error().message;
    EXPECT_NEAR(topOf(*state), 1, 1e-12);
    EXPECT_FALSE(state->isMoving());
    EXPECT_FALSE(stateFromQuery({{"toward", "cell:9"}, {"polytope", "tesseract"}}));
    EXPECT_FALSE(stateFromQuery({{"toward", "cell:"}, {"polytope", "tesseract"}, {"toward", "x"}}));
}

TEST(Focus, MovesFromVertexToVertex) {
    Session session;
    line(session, "polytope 600-cell");
    line(session, "toward vertex 0");
    finish(session);
    // The w of the vertices is cos 0°, 36°, 60°, 72°, 90° and so on, times the circumradius (Coxeter, Regular
    // Polytopes, table V(iii)).
    const double radius = slicing::infoOf(session.current.object).circumradius;
    std::vector<double> cosines;
    for (const double degrees : {90, 72, 60, 36, 0}) cosines.push_back(std::cos(degrees * std::numbers::pi / 180));
    EXPECT_NEAR(session.current.focusW(), 0, 1e-12);
    for (std::size_t i = 1; i < cosines.size(); ++i) {
        press(session, ")");
        EXPECT_NEAR(session.current.focusW(), cosines[i] * radius, 1e-9);
        EXPECT_LE(std::abs(session.current.slices.offset), session.current.slices.spacing / 2 * (1 + 1e-12));
    }
    const State top = session.current;
    press(session, ")");
    EXPECT_EQ(session.current, top) << "there is no vertex above";
    for (std::size_t i = cosines.size() - 1; i-- > 0;) {
        press(session, "(");
        EXPECT_NEAR(session.current.focusW(), cosines[i] * radius, 1e-9);
    }
    press(session, "(");
    EXPECT_NEAR(session.current.focusW(), -cosines[1] * radius, 1e-9);
    press(session, "0");
    EXPECT_EQ(session.current.slices.offset, 0);
    EXPECT_EQ(session.current.slices.focus, 0);
}

TEST(Offset, MovesAllHyperplanes) {
    Session session;
    line(session, "set offset=0.25 spacing=0.5 slices=5 focus=1");
    const auto planes = session.current.hyperplanes();
    EXPECT_DOUBLE_EQ(planes.w(0), 0.25 - 0.5);
    EXPECT_DOUBLE_EQ(planes.w(4), 0.25 + 1.5);
    EXPECT_DOUBLE_EQ(session.current.focusW(), 0.75);
    press(session, "G");
    EXPECT_LE(session.current.focusW(), topOf(session.current) + 1e-9);
    EXPECT_GT(session.current.focusW() + 0.5, topOf(session.current));
    line(session, "set w=-0.6");
    EXPECT_DOUBLE_EQ(session.current.focusW(), -0.6);
    EXPECT_EQ(session.current.slices.focus, -1);
    EXPECT_NEAR(session.current.slices.offset, -0.1, 1e-12);
    expectRefused(session, CommandLine{"set w=1000"}, ErrorCode::out_of_range, "w must be from");
    expectRefused(session, CommandLine{"set offset=1000"}, ErrorCode::out_of_range, "the offset must be from");
    line(session, "polytope 24-cell");
    EXPECT_EQ(session.current.slices.offset, 0);
}

TEST(Gesture, IsOneUndoStep) {
    Session session;
    press(session, "2");
    const State before = session.current;
    must(session, Rotate{{geometry::Plane::xw, 0.1, {}}});
    for (int i = 0; i < 9; ++i) must(session, Rotate{{geometry::Plane::xw, 0.1, {}}, true});
    EXPECT_EQ(session.undoSteps.size(), 2U);
    const State after = session.current;
    must(session, Undo{});
    EXPECT_EQ(session.current, before);
    must(session, Redo{});
    EXPECT_EQ(session.current, after);
    must(session, Undo{});
    must(session, Rotate{{geometry::Plane::xw, 0.1, {}}, true});
    must(session, Undo{});
    EXPECT_EQ(session.current, before) << "after an undo, there is nothing to continue";
}

}  // namespace
}  // namespace oval4d::session
