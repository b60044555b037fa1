// Tests of the keys that highlight one element after another.

#include <cmath>
#include <cstddef>
#include <optional>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "session/settings.hpp"
#include "unit/session/support.hpp"

namespace oval4d::session {
namespace {

using slicing::Element;
using slicing::ElementKind;

// Presses keys, and returns the index of the highlighted element. Expects an element of the kind `kind`.
std::size_t indexAfter(Session& session, const std::string& keys, ElementKind kind) {
    press(session, keys);
    const std::optional<Element> highlight = session.current.look.highlight;
    if (!highlight) {
        ADD_FAILURE() << "nothing is highlighted after " << keys;
        return 0;
    }
    EXPECT_EQ(highlight->kind, kind) << keys;
    return highlight->index;
}

// Presses keys `times` times. Returns the indices of all elements that are highlighted in the meantime.
std::set<std::size_t> visitedBy(Session& session, const std::string& keys, ElementKind kind, std::size_t times) {
    std::set<std::size_t> visited;
    for (std::size_t i = 0; i < times; ++i) visited.insert(indexAfter(session, keys, kind));
    return visited;
}

// Returns the index of the first element of a kind whose center has this w.
std::size_t firstWithCenterAt(double w, const State& state, ElementKind kind) {
    for (std::size_t i = 0; i < slicing::elementCount(state.object, kind); ++i) {
        if (std::abs(slicing::measureElement(state.object, {kind, i}).center.w - w) < 1e-9) return i;
    }
    ADD_FAILURE() << "no element has its center at w = " << w;
    return 0;
}

TEST(HighlightKeys, GoFromElementToElementAndRoundAndRound) {
    struct {
        const char *next, *previous;
        ElementKind kind;
    } const rows[] = {{"vc", "vC", ElementKind::cell},
                      {"vf", "vF", ElementKind::face},
                      {"ve", "vE", ElementKind::edge},
                      {"vv", "vV", ElementKind::vertex}};
    for (const auto& [next, previous, kind] : rows) {
        Session session;
        line(session, "polytope tesseract");
        press(session, "ryt");
        const std::size_t count = slicing::elementCount(session.current.object, kind);
        const std::size_t first = indexAfter(session, next, kind);
        for (std::size_t i = 1; i <= count; ++i) EXPECT_EQ(indexAfter(session, next, kind), (first + i) % count);
        for (std::size_t i = 1; i <= count; ++i)
            EXPECT_EQ(indexAfter(session, previous, kind), (first + count - i) % count);
    }
}

TEST(HighlightKeys, BeginWithTheFirstElementThatTheFocusSliceCuts) {
    for (const char* direction : {"next", "previous"}) {
        const auto after = [&](const std::string& command, char next, ElementKind kind) {
            Session session;
            line(session, "polytope tesseract");
            line(session, command);
            line(session, kind == ElementKind::cell ? "highlight edge 3" : "highlight cell 3");
            const char second = direction[0] == 'n' ? next : static_cast<char>(next - 'a' + 'A');
            return indexAfter(session, std::string("v") + second, kind);
        };
        Session session;
        line(session, "polytope tesseract");
        const State& state = session.current;
        // The vertices of the tesseract are at w = ±1. An element with its center at w = 0 extends from w = −1 to 1.
        for (const double w : {0, 1}) {
            const std::string command = "set w=" + std::to_string(w);
            EXPECT_EQ(after(command, 'c', ElementKind::cell), firstWithCenterAt(w, state, ElementKind::cell));
            EXPECT_EQ(after(command, 'f', ElementKind::face), firstWithCenterAt(w, state, ElementKind::face));
            EXPECT_EQ(after(command, 'e', ElementKind::edge), firstWithCenterAt(w, state, ElementKind::edge));
        }
        EXPECT_EQ(after("set w=1", 'v', ElementKind::vertex), firstWithCenterAt(1, state, ElementKind::vertex));
        EXPECT_EQ(after("set w=0", 'v', ElementKind::vertex), 0U) << "the slice contains no vertex";
        EXPECT_EQ(after("set w=1.5", 'c', ElementKind::cell), 0U) << "the slice is empty";
    }
}

TEST(HighlightKeys, SkipWhatIsHidden) {
    Session session;
    line(session, "polytope 5,7-duoprism");
    EXPECT_EQ(visitedBy(session, "vc", ElementKind::cell, 12).size(), 12U);
    EXPECT_EQ(visitedBy(session, "vf", ElementKind::face, 47).size(), 47U);
    line(session, "fade pentagonal prism");
    EXPECT_EQ(visitedBy(session, "vC", ElementKind::cell, 12).size(), 12U) << "what is faded is visible";
    line(session, "highlight none");
    line(session, "hide pentagonal prism");
    const auto types = slicing::typesOfCells(session.current.object);
    const std::set<std::size_t> cells = visitedBy(session, "vc", ElementKind::cell, 12);
    EXPECT_EQ(cells, visitedBy(session, "vC", ElementKind::cell, 12));
    EXPECT_EQ(cells.size(), 5U) << "one heptagonal prism for each edge of the pentagon";
    for (const std::size_t cell : cells) EXPECT_EQ(types[cell], types[*cells.begin()]);
    // Each of the seven pentagons lies between two pentagonal prisms. All other elements belong to heptagonal prisms.
    EXPECT_EQ(visitedBy(session, "vf", ElementKind::face, 47).size(), 40U);
    EXPECT_EQ(visitedBy(session, "ve", ElementKind::edge, 70).size(), 70U);
    EXPECT_EQ(visitedBy(session, "vv", ElementKind::vertex, 35).size(), 35U);
    line(session, "hide heptagonal prism");
    for (const char* second : {"C", "f", "E", "v"}) {
        press(session, "v");
        expectRefused(session, KeyPress{second}, ErrorCode::out_of_range, "of the 5,7-duoprism is hidden");
    }
    press(session, "v");
    expectRefused(session, KeyPress{"c"}, ErrorCode::out_of_range, "every cell of the 5,7-duoprism is hidden");
    line(session, "show");
    EXPECT_EQ(visitedBy(session, "vc", ElementKind::cell, 12).size(), 12U);
}

TEST(HighlightKeys, LeaveAHiddenElement) {
    Session session;
    line(session, "polytope rectified 5-cell");
    const auto types = slicing::typesOfCells(session.current.object);
    const std::size_t first = indexAfter(session, "vc", ElementKind::cell);
    line(session, "hide");  // hides the kind of the highlighted cell
    EXPECT_NE(types[indexAfter(session, "vc", ElementKind::cell)], types[first]);
    EXPECT_EQ(visitedBy(session, "vC", ElementKind::cell, 10).size(), 5U);
}

TEST(HighlightKeys, MakeUndoStepsLikeTheSetting) {
    Session session, other;
    for (Session* one : {&session, &other}) line(*one, "polytope 24-cell");
    const State before = session.current;
    const std::size_t first = indexAfter(session, "vc", ElementKind::cell);
    line(other, "highlight cell " + std::to_string(first));
    EXPECT_EQ(session, other);
    const State after = session.current;
    press(session, "vc");
    EXPECT_EQ(session.undoSteps.size(), other.undoSteps.size() + 1);
    press(session, "u");
    EXPECT_EQ(session.current, after);
    press(session, "u");
    EXPECT_EQ(session.current, before);
    must(session, Redo{});
    EXPECT_EQ(session.current, after);
}

TEST(HighlightKeys, LeaveTheKeysThatTurnTowardW) {
    Session session;
    line(session, "polytope 24-cell");
    press(session, "r");
    press(session, "zv");
    EXPECT_TRUE(session.current.ongoingTurnToward);
    EXPECT_FALSE(session.current.look.highlight);
    press(session, "vzc");
    EXPECT_FALSE(session.current.look.highlight) << "z ends the sequence that v has begun, and begins its own";
}

TEST(HighlightKeys, WorkForPointsSurfacesAndFields) {
    Session session;
    must(session, LoadObject{"points", "cloud", "0 0 0 -0.9\n0 0 0 0.04\n0 0 0 -0.02\n0 0 0 0.9\n"});
    line(session, "set spacing=0.1");
    EXPECT_EQ(indexAfter(session, "vv", ElementKind::vertex), 1U) << "it is in the focus slice, which is 0.1 thick";
    EXPECT_EQ(indexAfter(session, "vv", ElementKind::vertex), 2U);
    EXPECT_EQ(indexAfter(session, "vVvVvV", ElementKind::vertex), 3U);
    for (const char* second : {"c", "F", "e"}) {
        press(session, "v");
        expectRefused(session, KeyPress{second}, ErrorCode::out_of_range, "the points has no ");
    }
    must(session, LoadObject{"triangle", "off", "4OFF\n3 1 3\n1 0 0 0\n0 1 0 0\n0 0 1 0\n3 0 1 2\n"});
    EXPECT_EQ(indexAfter(session, "vf", ElementKind::face), 0U);
    EXPECT_EQ(visitedBy(session, "ve", ElementKind::edge, 3).size(), 3U);
    EXPECT_EQ(visitedBy(session, "vV", ElementKind::vertex, 3).size(), 3U);
    press(session, "v");
    expectRefused(session, KeyPress{"c"}, ErrorCode::out_of_range, "the triangle has no cell");
    line(session, "formula x^2+y^2+z^2 < 1+w^2");
    EXPECT_EQ(visitedBy(session, "vc", ElementKind::cell, 8).size(), 8U) << "the cells of the box";
}

}  // namespace
}  // namespace oval4d::session
