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
            if (session.current.turning) advance(session, 0.01);
            if (session.undoSteps.size() > steps) {
                seen.push_back(session.current);
            } else {
                seen.back() = session.current;  // a change without a step: turning stopped, or nothing changed
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
            must(session, Key{"r", false, true});
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
    for (int i = 0; i < 100; ++i) advance(session, 0.016);
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
    for (int i = 0; i < 60; ++i) advance(session, 1.0 / 60);
    press(session, " ");
    for (int i = 0; i < static_cast<int>(kTurnsPerSecond); ++i) press(stepped, ".");
    expectNear(session.current, stepped.current, 1e-12);
    const auto revision = session.revision;
    advance(session, 1);
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
    for (int i = 0; i < 20; ++i) must(session, Key{"2"}, limits);
    EXPECT_EQ(session.undoSteps.size(), 5U);
    for (int i = 0; i < 5; ++i) must(session, Key{"u"}, limits);
    expectRefused(session, Key{"u"}, ErrorCode::nothing_to_undo, "nothing to undo", limits);
    Session forgetful;
    must(forgetful, Key{"2"}, Limits{.maxUndo = 0});
    EXPECT_TRUE(forgetful.undoSteps.empty());
}

TEST(History, NothingToRepeat) {
    Session session;
    expectRefused(session, Key{"."}, ErrorCode::nothing_to_undo, "no rotation has been made yet");
    expectRefused(session, Key{" "}, ErrorCode::nothing_to_undo, "no rotation has been made yet");
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
    Set same;
    same.orientation = session.current.orientation.matrix();
    must(session, same);
    EXPECT_EQ(session.revision, 1U);
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
        commit(session, std::move(next), limits);
    }
    EXPECT_EQ(historyMemory(session), 7 * sizeof(State));
    forgetOlderHalf(session);
    ASSERT_EQ(session.undoSteps.size(), 3U);
    EXPECT_EQ(session.undoSteps.front().slices.focus, 4);
    EXPECT_EQ(session.current.slices.focus, 7);
    for (int i = 0; i < 5; ++i) forgetOlderHalf(session);
    EXPECT_TRUE(session.undoSteps.empty());
}

}  // namespace
}  // namespace oval4d::session
