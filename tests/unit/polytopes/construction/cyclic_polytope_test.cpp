// Tests that compare cyclic polytopes with theory and with the convex hulls of their vertices.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "polytopes/catalogue/catalogue.hpp"
#include "polytopes/construction/convex_hull.hpp"
#include "polytopes/construction/design.hpp"
#include "polytopes/construction/notations.hpp"
#include "polytopes/polytope.hpp"
#include "unit/polytopes/support.hpp"

namespace oval4d::polytopes {
namespace {

ElementCounts countsIn(const Polytope& p) {
    return {p.vertices.size(), p.edges.size(), p.faces.size(), p.cells.size()};
}

std::set<std::uint32_t> cornersOf(const Polytope& p, std::size_t cell) {
    std::set<std::uint32_t> corners;
    for (const std::uint32_t f : p.cells[cell]) corners.insert(p.faces[f].begin(), p.faces[f].end());
    return corners;
}

// Returns the number of permutations of the points that preserve all distances. Counts only permutations that map the
// first points to the points with the indices `images`.
std::uint64_t countIsometries(const std::vector<glm::dvec4>& points, std::vector<std::size_t>& images) {
    const std::size_t next = images.size();
    if (next == points.size()) return 1;
    std::uint64_t count = 0;
    for (std::size_t image = 0; image < points.size(); ++image) {
        bool preserves = true;
        for (std::size_t k = 0; k < next && preserves; ++k) {
            const double before = glm::distance(points[k], points[next]);
            preserves = std::abs(glm::distance(points[images[k]], points[image]) - before) < 1e-9;
        }
        if (!preserves) continue;
        images.push_back(image);
        count += countIsometries(points, images);
        images.pop_back();
    }
    return count;
}

class CyclicPolytopeOf : public testing::TestWithParam<std::uint32_t> {
  protected:
    const std::uint32_t n = GetParam();
    const std::string name = "cyclic polytope C(" + std::to_string(n) + ",4)";
    const PolytopeDesign design = support::designFor(name);
    const Polytope polytope = build(design);
};

TEST_P(CyclicPolytopeOf, hasTheNumbersOfElementsOfTheoryAndEulersFormula) {
    const ElementCounts found = countsIn(polytope);
    EXPECT_EQ(found, (ElementCounts{n, n * (n - 1) / 2, n * (n - 3), n * (n - 3) / 2}));
    EXPECT_EQ(found, elementCounts(design));
    EXPECT_EQ(found.vertices + found.faces, found.edges + found.cells);
}

TEST_P(CyclicPolytopeOf, joinsEveryTwoVerticesByAnEdge) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> joined, pairs;
    for (const auto& [a, b] : polytope.edges) joined.emplace(a, b);
    for (std::uint32_t a = 0; a < n; ++a) {
        for (std::uint32_t b = a + 1; b < n; ++b) pairs.emplace(a, b);
    }
    EXPECT_EQ(joined, pairs);
}

TEST_P(CyclicPolytopeOf, hasItsVerticesOnTheCurveAndOnASphere) {
    ASSERT_EQ(polytope.vertices.size(), n);
    const double radius = polytope.circumradius / std::numbers::sqrt2;
    glm::dvec4 sum(0);
    for (std::uint32_t k = 0; k < n; ++k) {
        const double t = 2 * std::numbers::pi * k / n;
        const glm::dvec4 point(std::cos(t), std::sin(t), std::cos(2 * t), std::sin(2 * t));
        EXPECT_LT(glm::distance(polytope.vertices[k], radius * point), 1e-12 * radius) << k;
        EXPECT_NEAR(glm::length(polytope.vertices[k]), polytope.circumradius, 1e-12 * radius) << k;
        sum += polytope.vertices[k];
    }
    EXPECT_LT(glm::length(sum), 1e-12 * radius);
}

TEST_P(CyclicPolytopeOf, hasTheLeastEdgeLengthTwoBetweenNeighbors) {
    for (const auto& [a, b] : polytope.edges) {
        const double length = glm::distance(polytope.vertices[a], polytope.vertices[b]);
        if (b - a == 1 || b - a == n - 1) {
            EXPECT_NEAR(length, 2, 1e-12);
        } else {
            EXPECT_GT(length, 2 - 1e-12);
        }
    }
}

// By Gale's evenness condition, four vertices are the corners of a cell if an even number of these four vertices lies
// between any two other vertices.
TEST_P(CyclicPolytopeOf, hasTheCellsOfGalesEvennessCondition) {
    std::set<std::set<std::uint32_t>> found, expected;
    for (std::size_t c = 0; c < polytope.cells.size(); ++c) found.insert(cornersOf(polytope, c));
    std::vector<bool> chosen(n, false);
    std::fill(chosen.end() - 4, chosen.end(), true);
    do {
        std::set<std::uint32_t> corners;
        std::set<std::size_t> parities;  // for each other vertex, the parity of the number of corners before it
        for (std::uint32_t k = 0; k < n; ++k) {
            if (chosen[k]) {
                corners.insert(k);
            } else {
                parities.insert(corners.size() % 2);
            }
        }
        if (parities.size() == 1) expected.insert(corners);
    } while (std::next_permutation(chosen.begin(), chosen.end()));
    EXPECT_EQ(found, expected);
}

TEST_P(CyclicPolytopeOf, isTheConvexHullOfItsVertices) {
    EXPECT_TRUE(polytope.convex);
    EXPECT_EQ(countsIn(polytope), countsIn(hullPolytope("hull", polytope.vertices)));
}

TEST_P(CyclicPolytopeOf, hasTheSymmetriesOfTheory) {
    std::vector<std::size_t> images;
    EXPECT_EQ(symmetryOrder(design), countIsometries(polytope.vertices, images));
}

TEST_P(CyclicPolytopeOf, hasCongruentCellsInEachKindOnly) {
    using Lengths = std::vector<long>;  // the rounded lengths of a cell's edges, in ascending order
    std::map<Lengths, std::set<std::uint32_t>> kinds;
    for (std::size_t c = 0; c < polytope.cells.size(); ++c) {
        const std::set<std::uint32_t> corners = cornersOf(polytope, c);
        Lengths lengths;
        for (const std::uint32_t a : corners) {
            for (const std::uint32_t b : corners) {
                const double length = glm::distance(polytope.vertices[a], polytope.vertices[b]);
                if (a < b) lengths.push_back(std::lround(length * 1e6));
            }
        }
        std::sort(lengths.begin(), lengths.end());
        kinds[lengths].insert(polytope.typeOfCell[c]);
    }
    EXPECT_EQ(kinds.size(), polytope.cellTypes.size());
    for (const auto& [lengths, types] : kinds) EXPECT_EQ(types.size(), 1U);
    for (const CellType& type : polytope.cellTypes) EXPECT_EQ(symmetryOrder(design) % type.cells, 0U);
}

TEST_P(CyclicPolytopeOf, isBuiltAgainFromItsName) {
    EXPECT_EQ(design.name, name);
    EXPECT_EQ(polytope.name, name);
    EXPECT_TRUE(polytope.rebuildableFromName);
}

INSTANTIATE_TEST_SUITE_P(Vertices, CyclicPolytopeOf, testing::Values(6U, 7U, 8U, 9U, 12U, 19U));

TEST(CyclicPolytopes, ofFiveVerticesAreThe5Cell) {
    for (const char* text : {"cyclic polytope C(5,4)", "C(5,4)", "5-cyclic polytope"}) {
        EXPECT_EQ(support::designFor(text).name, "5-cell") << text;
        EXPECT_NE(findEntry(text), nullptr) << text;
    }
}

TEST(CyclicPolytopes, areNamedAfterTheirNumbersOfVertices) {
    for (const char* text : {"cyclic polytope C(7,4)", "cyclic polytope C(7, 4)", "Cyclic Polytope c( 7 , 4 )",
                             "cyclic-polytope-C(7,4)", "C(7,4)", "c(7, 4)", "7-cyclic polytope", "7 cyclic polytope"})
        EXPECT_EQ(support::designFor(text).name, "cyclic polytope C(7,4)") << text;
    EXPECT_EQ(support::designFor("dual of C(7, 4)").name, "dual of cyclic polytope C(7,4)");
    EXPECT_EQ(support::designFor("hull of 7-cyclic polytope and tesseract of circumradius 2").name,
              "hull of cyclic polytope C(7,4) and 8-cell of circumradius 2");
}

TEST(CyclicPolytopes, ofOtherNumbersAreRefused) {
    for (const char* text :
         {"cyclic polytope", "cyclic polytope 7", "cyclic polytope C(4,4)", "C(0,4)", "C(7,3)", "C(7)", "C(7,4,4)",
          "C(7,4", "C()", "C(1 2,4)", "C(1000001,4)", "4-cyclic polytope", "5/2-cyclic polytope",
          "15/2-cyclic polytope", "1 2-cyclic polytope", "teapot cyclic polytope"}) {
        const auto named = designNamed(text, 100'000);
        ASSERT_TRUE(std::holds_alternative<PolytopeNameError>(named)) << text;
        EXPECT_EQ(std::get<PolytopeNameError>(named).message,
                  "a cyclic polytope is named after the number of its vertices, from 5 to 448, as in cyclic polytope "
                  "C(7,4) or 7-cyclic polytope")
            << text;
    }
    for (const char* text : {"polytope C", "acyclic polytope", "7-acyclic polytope", "cyclic", "C 7 4"})
        EXPECT_TRUE(std::holds_alternative<PolytopeNameError>(designNamed(text, 100'000))) << text;
}

TEST(CyclicPolytopes, areLimitedInTheirVertices) {
    for (const char* text : {"449", "1000000"}) {
        const auto large = designNamed(std::string("C(") + text + ",4)", 10'000'000);
        ASSERT_TRUE(std::holds_alternative<PolytopeNameError>(large));
        const auto& error = std::get<PolytopeNameError>(large);
        EXPECT_EQ(error.reason, PolytopeNameError::Reason::too_large);
        EXPECT_EQ(error.message, std::string("the cyclic polytope C(") + text + ",4) has " + text +
                                     " vertices; at most 448 are allowed");
    }
    EXPECT_TRUE(std::holds_alternative<PolytopeNameError>(designNamed("C(9,4)", 8)));
    EXPECT_TRUE(std::holds_alternative<PolytopeDesign>(designNamed("C(9,4)", 9)));
    const Polytope largest = build(support::designFor("C(448,4)"));
    EXPECT_TRUE(largest.convex);
    EXPECT_EQ(largest.cells.size(), 99'680U);
}

}  // namespace
}  // namespace oval4d::polytopes
