#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "session/history.hpp"
#include "unit/session/support.hpp"

namespace oval4d::session {
namespace {

TEST(History, UndoAndRedoReturnEqualStatesOverRandomKeys) {
    std::mt19937 random(4);
    const std::string keys = "234567rtyRTYkjKJlh0G[]{}nNopfbe.  ";
    for (int round = 0; round < 20; ++round) {
        Session session;
        std::vector<State> seen;
        seen.push_back(session.current);
        press(session, "2");
        seen.push_back(session.current);
        for (int i = 0; i < 200; ++i) {
            const std::size_t steps = session.undoSteps.size();
            const std::string key(1, keys[std::uniform_int_distribution<std::size_t>(0, keys.size() - 1)(random)]);
            press(session, key);
            if (session.current.turning) advanceMotionBy(session, 0.01);
            if (session.undoSteps.size() > steps) {
                seen.push_back(session.current);
            } else {
                seen.back() = session.current;  // a change without an undo step: turning has stopped, or nothing has
                                                // changed
            }
        }
        ASSERT_EQ(session.undoSteps.size() + 1, seen.size());
        for (std::size_t i = seen.size(); i-- > 1;) {
            EXPECT_EQ(session.current, seen[i]);
            press(session, "u");
        }
        EXPECT_EQ(session.current, seen[0]);
        expectRefused(session, Undo{}, ErrorCode::nothing_to_undo, "nothing to undo");
        for (std::size_t i = 1; i < seen.size(); ++i) {
            must(session, KeyPress{"r", false, true});
            EXPECT_EQ(session.current, seen[i]);
        }
        expectRefused(session, Redo{}, ErrorCode::nothing_to_undo, "nothing to redo");
    }
}

TEST(History, AChangeForgetsWhatWasUndone) {
    Session session;
    press(session, "2u3");
    expectRefused(session, Redo{}, ErrorCode::nothing_to_undo, "nothing to redo");
}

TEST(History, AWholeTurnIsOneStep) {
    Session session;
    press(session, "r");
    const State before = session.current;
    press(session, " ");
    for (int i = 0; i < 100; ++i) advanceMotionBy(session, 0.016);
    press(session, " ");
    const State after = session.current;
    EXPECT_FALSE(after.turning);
    EXPECT_FALSE(after.orientation == before.orientation);
    press(session, "u");
    EXPECT_EQ(session.current, before);
    must(session, Redo{});
    EXPECT_EQ(session.current, after);
}

TEST(History, ATurnGoesOnAsTheLastRotation) {
    Session session;
    Session stepped;
    line(session, "rotate xw,yz 0.03 0.05");
    line(stepped, "rotate xw,yz 0.03 0.05");
    press(session, " ");
    for (int i = 0; i < 60; ++i) advanceMotionBy(session, 1.0 / 60);
    press(session, " ");
    for (int i = 0; i < static_cast<int>(kRotationRepeatsPerSecond); ++i) press(stepped, ".");
    expectNear(session.current, stepped.current, 1e-12);
    const auto revision = session.revision;
    advanceMotionBy(session, 1);
    EXPECT_EQ(session.revision, revision) << "a session that stands still does not move";
}

TEST(History, TheCameraIsNoStep) {
    Session session;
    press(session, "2");
    const std::size_t steps = session.undoSteps.size();
    const auto revision = session.revision;
    line(session, "set azimuth=0.5 zoom=2");
    EXPECT_EQ(session.undoSteps.size(), steps);
    EXPECT_EQ(session.revision, revision + 1);
    press(session, "u");
    EXPECT_EQ(session.current.look.orbit.azimuth, 0.5) << "undo leaves the camera where it is";
    line(session, "set elevation=0.1");
    must(session, Redo{});
    EXPECT_EQ(session.current.look.orbit, (scene::CameraOrbit{0.5, 0.1, 2}));
}

TEST(History, IsLimited) {
    Session session;
    const Limits limits{.maxUndo = 5};
    for (int i = 0; i < 20; ++i) must(session, KeyPress{"2"}, limits);
    EXPECT_EQ(session.undoSteps.size(), 5U);
    for (int i = 0; i < 5; ++i) must(session, KeyPress{"u"}, limits);
    expectRefused(session, KeyPress{"u"}, ErrorCode::nothing_to_undo, "nothing to undo", limits);
    Session forgetful;
    must(forgetful, KeyPress{"2"}, Limits{.maxUndo = 0});
    EXPECT_TRUE(forgetful.undoSteps.empty());
}

TEST(History, NothingToRepeat) {
    Session session;
    expectRefused(session, KeyPress{"."}, ErrorCode::nothing_to_undo, "no rotation has been made yet");
    expectRefused(session, KeyPress{" "}, ErrorCode::nothing_to_undo, "no rotation has been made yet");
    expectRefused(session, CommandLine{"set turning=on"}, ErrorCode::nothing_to_undo, "no rotation has been made yet");
}

TEST(History, ACommandThatChangesNothingLeavesTheRevision) {
    Session session;
    for (const char* text :
         {"reset", "set slices=21", "polytope pentachoron", "view oval", "set faces=on", "focus 0"}) {
        line(session, text);
        EXPECT_EQ(session.revision, 0U) << text;
        EXPECT_TRUE(session.undoSteps.empty()) << text;
    }
    press(session, "r");
    ChangeSettings same;
    same.orientation = session.current.orientation.matrix();
    must(session, same);
    EXPECT_EQ(session.revision, 1U);
}

TEST(History, ATurnThatIsStoppedAtOnceIsNoStep) {
    Session session;
    press(session, "r");
    const State before = session.current;
    press(session, "  ");
    EXPECT_EQ(session.current, before);
    const auto revision = session.revision;
    press(session, "u");
    EXPECT_EQ(session.current.orientation, geometry::Rotation{}) << "undo takes back the rotation";
    EXPECT_EQ(session.revision, revision + 1);
    expectRefused(session, Undo{}, ErrorCode::nothing_to_undo, "nothing to undo");
    must(session, Redo{});
    EXPECT_EQ(session.current, before);
    expectRefused(session, Redo{}, ErrorCode::nothing_to_undo, "nothing to redo");
    const std::size_t steps = session.undoSteps.size();
    for (int i = 0; i < 10; ++i) press(session, "  ");
    EXPECT_LE(session.undoSteps.size(), steps + 1) << "such steps do not fill the history";
}

TEST(History, AGestureThatEndsWhereItBeganIsNoStep) {
    Session session;
    press(session, "r");
    const auto drag = [&](double angle, bool continues) {
        ChangeSettings set;
        set.orientation = geometry::Rotation(geometry::RotationAngles{geometry::Plane::xw, angle, {}}).matrix();
        set.continues = continues;
        must(session, set);
    };
    drag(0.5, false);
    const State before = session.current;
    drag(1, false);
    drag(0.5, true);
    ASSERT_EQ(session.current, before);
    Session undone = session;
    press(undone, "u");
    EXPECT_EQ(undone.current, session.undoSteps[1]) << "undo passes over the gesture";
    EXPECT_EQ(undone.revision, session.revision + 1);
    must(undone, Redo{});
    EXPECT_EQ(undone.current, before);
    drag(2, true);
    press(session, "u");
    EXPECT_EQ(session.current, before) << "a gesture that goes on is a step";
}

TEST(History, AGestureMayMakeAnImageAnew) {
    Session session;
    line(session, "set pace=2");
    const State before = session.current;
    line(session, "set pace=3");
    ChangeSettings back;
    back.pace = 2;
    back.continues = true;
    must(session, back);
    EXPECT_NE(session.current.object, before.object);
    press(session, "u");
    EXPECT_EQ(session.current, Session{}.current);
}

TEST(History, AMotionMayEndAtARedoStep) {
    Session session;
    press(session, "r .u");
    const State next = session.redoSteps.back();
    advanceMotionBy(session, 1 / kRotationRepeatsPerSecond);
    EXPECT_EQ(session.current, next);
    expectRefused(session, Redo{}, ErrorCode::nothing_to_undo, "nothing to redo");
    press(session, "u");
    must(session, Redo{});
    EXPECT_EQ(session.current, next);
}

TEST(History, TurningByTheAngleZeroChangesNothing) {
    Session session;
    line(session, "rotate xw,yz 0 0");
    press(session, " ");
    const Session before = session;
    for (int i = 0; i < 10; ++i) advanceMotionBy(session, 0.1);
    EXPECT_EQ(session, before);
}

// Undo skips steps that equal the current state apart from the camera. Stored sessions may contain such steps.
TEST(History, StoredStepsMayEqualTheCurrentState) {
    Session session;
    press(session, "r");
    session.undoSteps.push_back(session.undoSteps.back());
    for (int i = 0; i < 2; ++i) session.undoSteps.push_back(session.current);
    session.redoSteps.push_back(session.current);
    line(session, "set zoom=2");
    expectRefused(session, Redo{}, ErrorCode::nothing_to_undo, "nothing to redo");
    const State before = session.current;
    const auto revision = session.revision;
    press(session, "u");
    EXPECT_EQ(session.revision, revision + 1);
    EXPECT_EQ(session.current.orientation, geometry::Rotation{});
    expectRefused(session, Undo{}, ErrorCode::nothing_to_undo, "nothing to undo");
    must(session, Redo{});
    EXPECT_EQ(session.current, before);
}

TEST(History, AGestureKeepsTheHistoryWithinTheLimits) {
    Session session;
    const Limits limits{.maxUndoBytes = 1000};
    must(session, CommandLine{"boost x 0.1"}, limits);
    press(session, "r");
    must(session, KeyPress{"r"}, limits);
    EXPECT_EQ(session.undoSteps.size(), 3U);
    ChangeSettings next;
    next.boost = glm::dvec3(0, 0.1, 0);
    next.continues = true;
    must(session, next, limits);
    EXPECT_TRUE(session.undoSteps.empty()) << "only the undo steps have the former image";
}

TEST(History, ResetKeepsPolytopeAndSettings) {
    Session session;
    line(session, "polytope 600-cell");
    press(session, "rrkl} ");
    const State before = session.current;
    line(session, "reset");
    EXPECT_EQ(session.current.orientation, geometry::Rotation{});
    EXPECT_EQ(session.current.slices.focus, 0);
    EXPECT_FALSE(session.current.turning);
    EXPECT_EQ(session.current.object, before.object);
    EXPECT_EQ(session.current.slices.count, before.slices.count);
    EXPECT_EQ(session.current.alpha, before.alpha);
    press(session, "u");
    EXPECT_EQ(session.current, before);
}

TEST(History, TheOlderHalfIsForgotten) {
    Session session;
    const Limits limits;
    for (int i = 0; i < 7; ++i) {
        State next = session.current;
        next.slices.focus = i + 1;
        commitUndoStep(session, std::move(next), limits);
    }
    EXPECT_EQ(historyMemoryWithoutObjects(session), 7 * sizeof(State));
    forgetOlderUndoSteps(session);
    ASSERT_EQ(session.undoSteps.size(), 3U);
    EXPECT_EQ(session.undoSteps.front().slices.focus, 4);
    EXPECT_EQ(session.current.slices.focus, 7);
    for (int i = 0; i < 5; ++i) forgetOlderUndoSteps(session);
    EXPECT_TRUE(session.undoSteps.empty());
}

// The rotations of a gesture, such as a drag, are one undo step. The key '.' repeats all of them as one rotation.
TEST(Gestures, AreOneRotation) {
    using geometry::Plane;
    using geometry::Rotation;
    using geometry::RotationAngles;
    Session session;
    must(session, Rotate{RotationAngles(Plane::yz, 0.4, 0.1)});
    const State before = session.current;
    const auto turn = [&](const RotationAngles& part, bool continues) { must(session, Rotate{part, continues}); };
    turn(RotationAngles(Plane::xw, 0.1), false);
    turn(RotationAngles(Plane::yw, -0.2), true);
    turn(RotationAngles(Plane::xw, 0.3) + RotationAngles(Plane::yw, 0.05), true);
    const State after = session.current;
    const Rotation whole = after.orientation * before.orientation.inverse();
    EXPECT_LT((Rotation(after.lastTurn.value()) * whole.inverse()).largerAngle(), 1e-9);
    press(session, ".");
    EXPECT_LT((session.current.orientation * (whole * after.orientation).inverse()).largerAngle(), 1e-9);
    press(session, "uu");
    EXPECT_EQ(session.current, before);
}

TEST(Gestures, AddUpInTheirPlaneBeyondHalfATurn) {
    using geometry::Plane;
    using geometry::RotationAngles;
    Session session;
    for (int i = 0; i < 5; ++i) must(session, Rotate{RotationAngles(Plane::zw, 1.5), i > 0});
    EXPECT_EQ(session.current.lastTurn.value().planes(), std::vector{Plane::zw});
    EXPECT_NEAR(*session.current.lastTurn.value()[Plane::zw], 7.5, 1e-12);
}

TEST(Gestures, ThatLeadBackAreNoRotation) {
    using geometry::Plane;
    using geometry::RotationAngles;
    Session session;
    must(session, Rotate{RotationAngles(Plane::xy, 0.25)});
    must(session, Rotate{RotationAngles(Plane::xw, 0.5)});
    must(session, Rotate{RotationAngles(Plane::yw, 0.5), true});
    must(session, Rotate{RotationAngles(Plane::yw, -0.5), true});
    must(session, Rotate{RotationAngles(Plane::xw, -0.5), true});
    EXPECT_EQ(session.current.lastTurn, RotationAngles(Plane::xy, 0.25));
}

}  // namespace
}  // namespace oval4d::session
