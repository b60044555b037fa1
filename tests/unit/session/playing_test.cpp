// Tests of playing: the focus moves from end to end and back.

#include <string>

#include <gtest/gtest.h>

#include "session/settings.hpp"
#include "unit/session/support.hpp"

namespace oval4d::session {
namespace {

constexpr double kStep = 0.25;  // duration of a step, in seconds

// Returns a session with a tesseract, whose w is from −1 to 1. At speed 1, the focus moves by a quarter per second.
Session tesseract() {
    Session session;
    line(session, "polytope tesseract");
    return session;
}

TEST(Playing, MovesTheFocusToAndFroAtItsSpeed) {
    Session session = tesseract();
    line(session, "set w=0.45");
    press(session, "P");
    EXPECT_NEAR(session.current.focusW(), 0.45, 1e-12);
    for (int i = 1; i <= 8; ++i) {
        advanceMotionBy(session, kStep);
        EXPECT_NEAR(session.current.focusW(), 0.45 + i * kStep / 4, 1e-12);
    }
    advanceMotionBy(session, kStep);
    EXPECT_NEAR(session.current.focusW(), 1, 1e-12) << "it does not go beyond the end";
    line(session, "play 2");
    for (int i = 1; i <= 15; ++i) {
        advanceMotionBy(session, kStep);
        EXPECT_NEAR(session.current.focusW(), 1 - i * kStep / 2, 1e-12);
    }
    press(session, "F");
    EXPECT_EQ(session.current.playSpeed, 4);
    advanceMotionBy(session, kStep);
    EXPECT_NEAR(session.current.focusW(), -1, 1e-12);
    advanceMotionBy(session, kStep);
    EXPECT_NEAR(session.current.focusW(), -1 + kStep, 1e-12) << "and back";
    press(session, "SSSS");
    EXPECT_EQ(session.current.playSpeed, 0.25);
    press(session, "P");
    const Session stopped = session;
    advanceMotionBy(session, kStep);
    EXPECT_EQ(session, stopped);
}

TEST(Playing, GoesOnInItsDirectionAfterAPause) {
    Session session = tesseract();
    line(session, "set w=1");
    line(session, "play");
    advanceMotionBy(session, kStep);
    advanceMotionBy(session, kStep);
    EXPECT_LT(session.current.focusW(), 1);
    line(session, "pause");
    const double w = session.current.focusW();
    line(session, "play");
    advanceMotionBy(session, kStep);
    EXPECT_LT(session.current.focusW(), w);
}

TEST(Playing, StaysWithinTheObjectWhileThatTurns) {
    Session session = tesseract();
    press(session, "r P");
    ASSERT_TRUE(session.current.turning && session.current.playing);
    for (int i = 0; i < 200; ++i) {
        advanceMotionBy(session, kStep);
        const auto [least, most] = slicing::rangeOfW(session.current.object, session.current.orientation);
        EXPECT_GE(session.current.focusW(), least - 1e-12);
        EXPECT_LE(session.current.focusW(), most + 1e-12);
    }
    line(session, "set w=10 playing=on");
    advanceMotionBy(session, kStep);
    EXPECT_NEAR(session.current.focusW(), slicing::rangeOfW(session.current.object, session.current.orientation).second,
                1e-12);
}

TEST(Playing, IsOneUndoStep) {
    Session session = tesseract();
    const State before = session.current;
    press(session, "P");
    for (int i = 0; i < 3; ++i) advanceMotionBy(session, kStep);
    press(session, "P");
    const State after = session.current;
    EXPECT_FALSE(after.playing);
    press(session, "u");
    EXPECT_EQ(session.current, before);
    must(session, Redo{});
    EXPECT_EQ(session.current, after);
}

TEST(Playing, EndsWhenSomethingElseMovesTheFocusAndUndoDoesNotBeginItAgain) {
    for (const char* command : {"key h", "key 0", "key G", "key )", "focus 3", "set offset=0.05", "set w=0.5",
                                "set point=0,0,0,0.25", "polytope 24-cell", "reset"}) {
        SCOPED_TRACE(command);
        Session session = tesseract();
        press(session, "P");
        for (int i = 0; i < 3; ++i) advanceMotionBy(session, kStep);
        State reached = session.current;
        line(session, command);
        EXPECT_FALSE(session.current.playing);
        press(session, "u");
        reached.playing = false;
        EXPECT_EQ(session.current, reached);
    }
    for (const char* command : {"set spacing=0.2", "set slices=31", "rotate xw 0.1", "view matrix", "set speed=2"}) {
        SCOPED_TRACE(command);
        Session session = tesseract();
        press(session, "P");
        advanceMotionBy(session, kStep);
        line(session, command);
        EXPECT_TRUE(session.current.playing);
    }
}

TEST(Playing, AFormulaThatIsEditedPlaysOn) {
    Session session;
    const auto formula = [](const std::string& text, bool continues) {
        return LoadObject{"mine", "formula", text, continues};
    };
    must(session, formula("x^2+y^2+z^2+w^2 < 1", false));
    line(session, "play");
    advanceMotionBy(session, kStep);
    must(session, formula("x^2+y^2+z^2+w^2 < 2", true));
    EXPECT_TRUE(session.current.playing);
    must(session, formula("x^2+y^2+z^2+w^2 < 3", false));
    EXPECT_FALSE(session.current.playing);
}

TEST(Playing, RefusesWhatIsNoSpeed) {
    Session session = tesseract();
    expectRefused(session, CommandLine{"play 100"}, ErrorCode::out_of_range, "the speed must be from");
    expectRefused(session, CommandLine{"play 0"}, ErrorCode::out_of_range, "the speed must be");
    expectRefused(session, CommandLine{"play fast"}, ErrorCode::bad_expression, "speed");
    expectRefused(session, CommandLine{"pause 2"}, ErrorCode::bad_expression, "takes no arguments");
}

TEST(Playing, DoesNothingInAFlatObject) {
    Session session;
    must(session, LoadObject{"flat", "cloud", "0 0 0 0\n1 0 0 0\n"});
    line(session, "play");
    advanceMotionBy(session, kStep);
    const Session before = session;
    advanceMotionBy(session, kStep);
    EXPECT_EQ(session, before);
}

}  // namespace
}  // namespace oval4d::session
