// Tests of coloring by kind, and of hidden and faded kinds of cells.

#include <gtest/gtest.h>

#include "polytopes/catalogue/catalogue.hpp"
#include "session/cell_types.hpp"
#include "session/query.hpp"
#include "unit/session/support.hpp"

namespace oval4d::session {
namespace {

using scene::CellTypeFilter;

/// Returns a session with a polytope that has four kinds of cells. Two kinds have the same name.
Session withKinds() {
    auto polytope = support::named("24-cell");
    polytope.name = "mixed";
    polytope.cellTypes = {{"cube", 6}, {"hexagonal prism", 6}, {"hexagonal prism", 6}, {"octahedron", 6}};
    for (std::size_t c = 0; c < polytope.cells.size(); ++c) polytope.typeOfCell[c] = c % 4;
    Session session;
    session.loaded["mixed"] = std::make_shared<const polytopes::Polytope>(std::move(polytope));
    line(session, "polytope mixed");
    return session;
}

TEST(CellTypeFilter, AreHiddenFadedAndShownAgain) {
    Session session = withKinds();
    EXPECT_EQ(session.current.look.cellTypes, CellTypeFilter{});
    line(session, ":hide 2 0");
    EXPECT_EQ(session.current.look.cellTypes, (CellTypeFilter{{0, 2}, {}}));
    line(session, "fade 3,2");
    EXPECT_EQ(session.current.look.cellTypes, (CellTypeFilter{{0}, {2, 3}})) << "what fades is no longer hidden";
    line(session, "hide 3");
    EXPECT_EQ(session.current.look.cellTypes, (CellTypeFilter{{0, 3}, {2}})) << "what hides is no longer faded";
    line(session, "show 0 2");
    EXPECT_EQ(session.current.look.cellTypes, (CellTypeFilter{{3}, {}}));
    line(session, "fade hexagonal prism");
    EXPECT_EQ(session.current.look.cellTypes, (CellTypeFilter{{3}, {1, 2}})) << "all of the name";
    line(session, "show");
    for (const char* const name : {"6-gonal prism", "6 gonal prism", "Hexagonal Prism"}) {
        line(session, std::string("hide ") + name);
        EXPECT_EQ(session.current.look.cellTypes, (CellTypeFilter{{1, 2}, {}})) << name;
        line(session, "show");
    }
    EXPECT_EQ(session.current.look.cellTypes, CellTypeFilter{});
}

TEST(CellTypeFilter, AreSettings) {
    Session session = withKinds();
    line(session, "set hidden=2,1,2 faded=0,1 color=kind");
    EXPECT_EQ(session.current.look.cellTypes, (CellTypeFilter{{1, 2}, {0}})) << "in both lists: hidden";
    EXPECT_EQ(session.current.look.coloring, scene::Coloring::cell_type);
    ChangeSettings set;
    set.hidden = {{0}};
    must(session, set);
    EXPECT_EQ(session.current.look.cellTypes, (CellTypeFilter{{0}, {}}));
    set = {};
    set.faded = {{0, 3}};
    must(session, set);
    EXPECT_EQ(session.current.look.cellTypes, (CellTypeFilter{{}, {0, 3}}));
    line(session, "set faded=none");
    EXPECT_EQ(session.current.look.cellTypes, CellTypeFilter{});
}

TEST(CellTypeFilter, CanBeUndoneAndGoWithThePolytope) {
    Session session = withKinds();
    line(session, "hide 1");
    line(session, "color w");
    press(session, "u");
    EXPECT_EQ(session.current.look.coloring, scene::Coloring::cell);
    line(session, "polytope mixed");
    EXPECT_EQ(session.current.look.cellTypes, (CellTypeFilter{{1}, {}})) << "the same polytope";
    line(session, "polytope 5-cell");
    EXPECT_EQ(session.current.look.cellTypes, CellTypeFilter{});
    press(session, "u");
    EXPECT_EQ(session.current.look.cellTypes, (CellTypeFilter{{1}, {}}));
    press(session, "u");
    EXPECT_EQ(session.current.look.cellTypes, CellTypeFilter{});
}

TEST(CellTypeFilter, AreCountedInThePolytopeThatIsSetWithThem) {
    Session session = withKinds();
    line(session, "polytope 5-cell");
    line(session, "set hidden=3 polytope=mixed");
    EXPECT_EQ(session.current.look.cellTypes, (CellTypeFilter{{3}, {}}));
}

TEST(CellTypeFilter, MistakesAreExplainedAndChangeNothing) {
    Session session = withKinds();
    line(session, "hide 1");
    const auto refused = [&](const char* text, ErrorCode code, const char* says) {
        SCOPED_TRACE(text);
        expectRefused(session, CommandLine{text}, code, says);
    };
    refused("hide", ErrorCode::bad_expression,
            "the number or the name of a kind of cell is expected; the kinds of the mixed, from 0, are cube, hexagonal "
            "prism");
    refused("hide prism", ErrorCode::bad_expression, "not 'prism'");
    refused("hide 7-gonal prism", ErrorCode::bad_expression, "not '7-gonal prism'");
    refused("fade 4", ErrorCode::out_of_range, "the mixed has 4 kinds of cells, 0 to 3; there is no 4");
    refused("show 99999999999", ErrorCode::bad_expression, "'99999999999'");
    refused("hide -1", ErrorCode::bad_expression, "'-1'");
    refused("set hidden=0.5", ErrorCode::bad_expression, "hidden: '0.5' is not the number of a kind of cell");
    refused("set faded=7", ErrorCode::out_of_range, "there is no 7");
    refused("set polytope=5-cell hidden=1", ErrorCode::out_of_range, "one kind of cell, 0; there is no 1");
    refused("color", ErrorCode::bad_expression, "color must be cell, kind, w, plain, light, growth or value, not ''");
    refused("color red", ErrorCode::bad_expression, "not 'red'");
}

TEST(CellTypeFilter, AreInQueries) {
    const auto state = stateFromQuery({{"hidden", "0"}, {"color", "plain"}, {"polytope", "8-cell"}}, {});
    ASSERT_TRUE(state) << state.error().message;
    EXPECT_EQ(state->look.cellTypes, (CellTypeFilter{{0}, {}}));
    EXPECT_EQ(state->look.coloring, scene::Coloring::plain);
    EXPECT_FALSE(stateFromQuery({{"faded", "1"}, {"polytope", "8-cell"}}, {}));
}

}  // namespace
}  // namespace oval4d::session
