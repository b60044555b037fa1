// Colours of cells, and which elements are seen where kinds of cells are hidden or faded.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "geometry/coxeter.hpp"
#include "geometry_support.hpp"
#include "scene/presence.hpp"
#include "scene/scene.hpp"

namespace {

using namespace oval4d;
using geometry::support::named;
using scene::Colour;
using scene::Colouring;
using scene::Presence;

std::vector<Colour> painted(const geometry::Polytope& polytope, Colouring colouring,
                            const geometry::Rotation& orientation = {}) {
    std::vector<Colour> colours;
    scene::CellColours().paint(polytope, colouring, orientation, colours);
    return colours;
}

int red(Colour colour) { return static_cast<int>(colour >> 16 & 255); }
int blue(Colour colour) { return static_cast<int>(colour & 255); }

/// The rectified 5-cell, whose cells are octahedra and tetrahedra: told apart by their number of 2-faces.
geometry::Polytope rectified() {
    const geometry::Branch three{3, 1};
    const auto diagram = geometry::Diagram::linear(three, three, three, {false, true, false, false});
    auto polytope = geometry::wythoff("rectified 5-cell", diagram, geometry::mirrorsOf(diagram));
    polytope.kinds = {{"octahedron"}, {"tetrahedron"}};
    for (std::size_t c = 0; c < polytope.cells.size(); ++c)
        polytope.cellKinds[c] = polytope.cells[c].size() == 8 ? 0 : 1;
    return polytope;
}

TEST(CellColours, AreDistinctWhereCellsAreFewAndStable) {
    for (const char* name : {"5-cell", "8-cell", "16-cell", "24-cell"}) {
        const auto colours = painted(named(name), Colouring::cell);
        EXPECT_EQ(std::set(colours.begin(), colours.end()).size(), named(name).cells.size());
        EXPECT_EQ(colours, painted(named(name), Colouring::cell));
    }
    EXPECT_EQ(painted(named("600-cell"), Colouring::cell).size(), 600U);
}

TEST(CellColours, ByKindAreOneForEachKind) {
    const auto polytope = rectified();
    const auto colours = painted(polytope, Colouring::kind);
    std::set<std::pair<std::uint32_t, Colour>> pairs;
    for (std::size_t c = 0; c < colours.size(); ++c) pairs.emplace(polytope.cellKinds[c], colours[c]);
    ASSERT_EQ(pairs.size(), 2U);
    EXPECT_NE(pairs.begin()->second, pairs.rbegin()->second);
    EXPECT_EQ(scene::kindColour(0, 2), pairs.begin()->second);
    EXPECT_EQ(scene::kindColour(1, 2), pairs.rbegin()->second);
}

TEST(CellColours, PlainIsOne) {
    const auto colours = painted(named("24-cell"), Colouring::plain);
    EXPECT_EQ(std::set(colours.begin(), colours.end()).size(), 1U);
}

TEST(CellColours, ByWRunFromBlueToAmberAsThePolytopeIsTurned) {
    const auto& polytope = named("8-cell");  // one cell at w = −1, one at w = 1, six at 0
    scene::CellColours painter;
    std::vector<Colour> colours;
    for (const double turned : {0.0, std::numbers::pi}) {
        const geometry::Rotation orientation(geometry::Turn{geometry::Plane::xw, turned, {}});
        painter.paint(polytope, Colouring::w, orientation, colours);
        for (std::size_t c = 0; c < colours.size(); ++c) {
            double w = 0;
            for (const auto f : polytope.cells[c]) {
                for (const auto v : polytope.faces[f]) w += orientation(polytope.vertices[v]).w / 24;
            }
            const int warmth = red(colours[c]) - blue(colours[c]);
            if (w > 0.5) {
                EXPECT_GT(warmth, 90);
            } else if (w < -0.5) {
                EXPECT_LT(warmth, -90);
            } else {
                EXPECT_LT(std::abs(warmth), 15);
            }
        }
    }
}

TEST(CellColours, FollowThePolytopeAndTheColouring) {
    scene::CellColours painter;
    std::vector<Colour> colours;
    for (const char* name : {"16-cell", "5-cell", "16-cell"}) {
        for (const Colouring colouring : {Colouring::cell, Colouring::w, Colouring::kind, Colouring::plain}) {
            painter.paint(named(name), colouring, {}, colours);
            EXPECT_EQ(colours, painted(named(name), colouring)) << name;
        }
    }
}

TEST(Presences, AreThoseOfTheMostVisibleCell) {
    const auto polytope = rectified();
    for (const scene::Kinds& kinds : {scene::Kinds{{0}, {}}, {{1}, {}}, {{}, {0}}, {{1}, {0}}, {{0, 1}, {}}}) {
        scene::Presences found;
        scene::findPresences(polytope, kinds, found);
        // Again, by going through all cells for each element.
        const auto presenceOf = [&](std::uint32_t kind) {
            for (const auto k : kinds.hidden)
                if (k == kind) return Presence::hidden;
            for (const auto k : kinds.faded)
                if (k == kind) return Presence::faded;
            return Presence::full;
        };
        const auto greatest = [&](auto&& holds) {
            Presence most = Presence::hidden;
            for (std::size_t c = 0; c < polytope.cells.size(); ++c) {
                bool in = false;
                for (const auto f : polytope.cells[c]) in = in || holds(f);
                if (in) most = std::max(most, presenceOf(polytope.cellKinds[c]));
            }
            return most;
        };
        for (std::uint32_t f = 0; f < polytope.faces.size(); ++f) {
            const Presence expected = greatest([&](std::uint32_t other) { return other == f; });
            EXPECT_EQ(found.edge(f), expected);
            EXPECT_EQ(found.face(static_cast<std::uint32_t>(polytope.cells.size()) + f), expected);
            if (expected == Presence::hidden) continue;
            EXPECT_NE(found.face(scene::tintOf(polytope, found, static_cast<std::uint32_t>(polytope.cells.size()) + f)),
                      Presence::hidden);
        }
        for (std::uint32_t e = 0; e < polytope.edges.size(); ++e) {
            const auto onLoop = [&](std::uint32_t f) {
                const auto edges = polytope.faceEdges[f];
                return std::find(edges.begin(), edges.end(), e) != edges.end();
            };
            EXPECT_EQ(found.vertex(e), greatest(onLoop));
            EXPECT_EQ(found.edge(static_cast<std::uint32_t>(polytope.faces.size()) + e), greatest(onLoop));
        }
        for (std::uint32_t v = 0; v < polytope.vertices.size(); ++v) {
            const auto onLoop = [&](std::uint32_t f) {
                const auto loop = polytope.faces[f];
                return std::find(loop.begin(), loop.end(), v) != loop.end();
            };
            EXPECT_EQ(found.vertex(static_cast<std::uint32_t>(polytope.edges.size()) + v), greatest(onLoop));
        }
    }
}

TEST(Presences, FollowTheLook) {
    const auto polytope = rectified();
    scene::Scene s;
    scene::Look look;
    const auto compose = [&](const geometry::Polytope& p) { scene::compose(p, {-1, 3, 1}, 0, look, {}, s); };
    compose(polytope);
    EXPECT_TRUE(s.presences.all());
    look.kinds = {{1}, {}};
    compose(polytope);
    EXPECT_FALSE(s.presences.all());
    look.kinds = {};
    compose(named("5-cell"));
    EXPECT_TRUE(s.presences.all());
    look.kinds = {{0}, {}};
    compose(named("5-cell"));
    EXPECT_EQ(s.presences.face(4), Presence::hidden);
}

}  // namespace
