// Tests that compare duoantiprisms with theory and with the convex hulls of their vertices.

#include <algorithm>
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
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include "polytopes/catalogue/catalogue.hpp"
#include "polytopes/construction/convex_hull.hpp"
#include "polytopes/construction/design.hpp"
#include "polytopes/polytope.hpp"
#include "unit/polytopes/support.hpp"

namespace oval4d::polytopes {
namespace {

constexpr double kPi = std::numbers::pi;

ElementCounts builtCounts(const Polytope& polytope) {
    return {polytope.vertices.size(), polytope.edges.size(), polytope.faces.size(), polytope.cells.size()};
}

// Returns the numbers of sides of the 2-faces of an antiprism over a polygon of `sides` sides, in ascending order. For
// a digon (2 sides), they are those of a disphenoid.
std::vector<std::size_t> facesOfAntiprism(std::size_t sides) {
    std::vector<std::size_t> faces(2 * sides, 3);
    if (sides > 2) faces.insert(faces.end(), 2, sides);
    return faces;
}

// Returns the hypervolume of the polytope: the sum over simplices with a corner at the origin, one for each triangle of
// a 2-face and a vertex of its cell.
double enclosedHypervolume(const Polytope& polytope) {
    double sum = 0;
    for (std::size_t c = 0; c < polytope.cells.size(); ++c) {
        const glm::dvec4 apex = polytope.vertices[polytope.faces[polytope.cells[c][0]][0]];
        for (std::uint32_t i = polytope.cells.begin[c]; i < polytope.cells.begin[c + 1]; ++i) {
            const auto loop = polytope.faces[polytope.cells.items[i]];
            for (std::size_t k = 1; k + 1 < loop.size(); ++k) {
                sum -= polytope.cellSigns[i] *
                       glm::determinant(glm::dmat4(apex, polytope.vertices[loop[0]], polytope.vertices[loop[k]],
                                                   polytope.vertices[loop[k + 1]]));
            }
        }
    }
    return sum / 24;
}

// Returns the number of orthogonal maps that map the set of vertices to itself. Each of them maps the corners of the
// first tetrahedral cell to those of a tetrahedral cell, in some order.
std::uint64_t countSymmetries(const Polytope& polytope) {
    std::vector<std::vector<std::uint32_t>> tetrahedra;
    for (std::size_t c = 0; c < polytope.cells.size(); ++c) {
        std::set<std::uint32_t> corners;
        for (const std::uint32_t f : polytope.cells[c])
            corners.insert(polytope.faces[f].begin(), polytope.faces[f].end());
        if (corners.size() == 4) tetrahedra.emplace_back(corners.begin(), corners.end());
    }
    const auto matrixOf = [&](const std::vector<std::uint32_t>& corners) {
        return glm::dmat4(polytope.vertices[corners[0]], polytope.vertices[corners[1]], polytope.vertices[corners[2]],
                          polytope.vertices[corners[3]]);
    };
    const auto isVertex = [&](const glm::dvec4& point) {
        return std::ranges::any_of(polytope.vertices,
                                   [&](const glm::dvec4& vertex) { return glm::distance(vertex, point) < 1e-6; });
    };
    const glm::dmat4 identity(1);
    const auto isSymmetry = [&](const glm::dmat4& map) {
        const glm::dmat4 product = glm::transpose(map) * map;
        for (int k = 0; k < 4; ++k) {
            if (glm::distance(product[k], identity[k]) > 1e-6) return false;
        }
        return std::ranges::all_of(polytope.vertices, [&](const glm::dvec4& v) { return isVertex(map * v); });
    };
    const glm::dmat4 inverse = glm::inverse(matrixOf(tetrahedra.at(0)));
    std::uint64_t count = 0;
    for (std::vector<std::uint32_t>& corners : tetrahedra) {
        do {
            if (isSymmetry(matrixOf(corners) * inverse)) ++count;
        } while (std::next_permutation(corners.begin(), corners.end()));
    }
    return count;
}

class DuoantiprismOf : public testing::TestWithParam<std::pair<int, int>> {
  protected:
    const int p = GetParam().first, q = GetParam().second;
    const std::size_t pairs = static_cast<std::size_t>(p) * static_cast<std::size_t>(q);
    const PolytopeDesign design = support::designFor(std::to_string(p) + "," + std::to_string(q) + "-duoantiprism");
    const Polytope polytope = build(design);
};

TEST_P(DuoantiprismOf, hasTheNumbersOfElementsOfTheoryAndEulersFormula) {
    const auto [vertices, edges, faces, cells] = builtCounts(polytope);
    EXPECT_EQ(elementCounts(design), builtCounts(polytope));
    EXPECT_EQ(vertices, 2 * pairs);
    EXPECT_EQ(vertices + faces, edges + cells);
}

TEST_P(DuoantiprismOf, hasAntiprismsAndDisphenoids) {
    std::map<std::vector<std::size_t>, std::size_t> found, expected;
    for (std::size_t c = 0; c < polytope.cells.size(); ++c) {
        std::vector<std::size_t> sides;
        for (const std::uint32_t f : polytope.cells[c]) sides.push_back(polytope.faces[f].size());
        std::sort(sides.begin(), sides.end());
        ++found[sides];
    }
    expected[facesOfAntiprism(static_cast<std::size_t>(q))] += 2 * static_cast<std::size_t>(p);
    expected[facesOfAntiprism(static_cast<std::size_t>(p))] += 2 * static_cast<std::size_t>(q);
    expected[facesOfAntiprism(2)] += 2 * pairs;
    EXPECT_EQ(found, expected);
    EXPECT_EQ(polytope.cellTypes.size(), p == q ? 2U : 3U);
}

TEST_P(DuoantiprismOf, isTheConvexHullOfEveryOtherVertexOfADuoprism) {
    std::vector<glm::dvec4> points;
    for (int i = 0; i < 2 * p; ++i) {
        for (int j = 0; j < 2 * q; ++j) {
            if ((i + j) % 2 != 0) continue;
            const double a = kPi * i / p, b = kPi * j / q;
            const double r = 1 / std::sin(kPi / p), s = 1 / std::sin(kPi / q);
            // The polygon with fewer sides has its circle in the xy plane.
            if (p <= q) {
                points.emplace_back(r * std::cos(a), r * std::sin(a), s * std::cos(b), s * std::sin(b));
            } else {
                points.emplace_back(s * std::cos(b), s * std::sin(b), r * std::cos(a), r * std::sin(a));
            }
        }
    }
    support::expectSamePoints(polytope.vertices, points, 1e-12 * polytope.circumradius);
    EXPECT_EQ(builtCounts(polytope), builtCounts(hullPolytope("hull", points)));
    EXPECT_TRUE(polytope.convex);
}

// The hypervolume of a duoantiprism is that of the duoprism, the area of the 2p-gon times the area of the 2q-gon,
// without a simplex at each removed vertex.
TEST_P(DuoantiprismOf, hasTheHypervolumeOfTheDuoprismWithoutItsCorners) {
    const double whole = p / std::sin(kPi / p) * q / std::sin(kPi / q);
    const double corner = 2 * std::tan(kPi / 2 / p) * 2 * std::tan(kPi / 2 / q) / 24;
    EXPECT_NEAR(enclosedHypervolume(polytope), whole - 2 * p * q * corner, 1e-9 * whole);
}

TEST_P(DuoantiprismOf, hasPolygonsOfEdgeLengthTwoAndOtherwiseEqualEdges) {
    const double between = std::hypot(1 / std::cos(kPi / 2 / p), 1 / std::cos(kPi / 2 / q));
    EXPECT_GT(between, std::numbers::sqrt2);
    EXPECT_LT(between, 2 - 1e-3);
    std::size_t ofPolygons = 0;
    for (const auto& [a, b] : polytope.edges) {
        const double length = glm::distance(polytope.vertices[a], polytope.vertices[b]);
        if (std::abs(length - 2) < 1e-9) {
            ++ofPolygons;
        } else {
            EXPECT_NEAR(length, between, 1e-9);
        }
    }
    EXPECT_EQ(ofPolygons, (p == 2 ? 1 : 2) * pairs + (q == 2 ? 1 : 2) * pairs);
}

TEST_P(DuoantiprismOf, hasTheRadiiThatMakeTheEdgesMostEqual) {
    const auto ratio = [&](double scale) {  // the ratio of the longest edge to the shortest edge if the xy plane is
                                            // scaled
        double least = 1e300, most = 0;
        for (const auto& [a, b] : polytope.edges) {
            glm::dvec4 along = polytope.vertices[a] - polytope.vertices[b];
            along.x *= scale;
            along.y *= scale;
            least = std::min(least, glm::length(along));
            most = std::max(most, glm::length(along));
        }
        return most / least;
    };
    for (const double scale : {0.5, 0.9, 0.999, 1.001, 1.1, 2.0}) EXPECT_GT(ratio(scale), ratio(1)) << scale;
}

TEST_P(DuoantiprismOf, hasTheSymmetriesOfTheory) { EXPECT_EQ(symmetryOrder(design), countSymmetries(polytope)); }

TEST_P(DuoantiprismOf, isNamedAfterThePolygonWithFewerSidesFirst) {
    const std::string name = std::to_string(std::min(p, q)) + "," + std::to_string(std::max(p, q)) + "-duoantiprism";
    EXPECT_EQ(design.name, name);
    EXPECT_EQ(polytope.name, name);
    EXPECT_EQ(support::designFor(name).name, name);
    EXPECT_EQ(build(support::designFor(name)).vertices, polytope.vertices);
}

INSTANTIATE_TEST_SUITE_P(Polygons, DuoantiprismOf,
                         testing::Values(std::pair{2, 3}, std::pair{2, 4}, std::pair{5, 2}, std::pair{2, 20},
                                         std::pair{3, 3}, std::pair{3, 4}, std::pair{4, 3}, std::pair{5, 5},
                                         std::pair{3, 12}, std::pair{6, 7}));

TEST(Duoantiprisms, ofDigonsAreThe16Cell) {
    for (const char* text : {"2,2-duoantiprism", "2-gonal duoantiprism"}) {
        EXPECT_EQ(support::designFor(text).name, "16-cell") << text;
        EXPECT_NE(findEntry(text), nullptr) << text;
    }
}

TEST(Duoantiprisms, areNamedAfterTwoPolygons) {
    for (const char* text :
         {"3,4-duoantiprism", "4,3-duoantiprism", "3-4 duoantiprism", "3x4 duoantiprism", "3×4-duoantiprism",
          "3, 4 Duoantiprism", "triangular-square duoantiprism", "4-gonal 3-gonal duoantiprism"})
        EXPECT_EQ(support::designFor(text).name, "3,4-duoantiprism") << text;
    for (const char* text : {"hexagonal duoantiprism", "hexagon duoantiprism", "6 duoantiprism"})
        EXPECT_EQ(support::designFor(text).name, "6,6-duoantiprism") << text;
    EXPECT_EQ(support::designFor("dual of 3-4 duoantiprism").name, "dual of 3,4-duoantiprism");
}

TEST(Duoantiprisms, haveSymbols) {
    const PolytopeDesign design = support::designFor("3,4-duoantiprism");
    EXPECT_EQ(linearNotationOf(design), "s3s2s4s");
    EXPECT_EQ(schlaefliOf(design), "ht0,1,2,3{3,2,4}");
}

TEST(Duoantiprisms, ofOtherThanTwoConvexPolygonsAreRefused) {
    for (const char* text :
         {"duoantiprism", "1,5-duoantiprism", "0-5 duoantiprism", "5/2,5-duoantiprism", "pentagrammic duoantiprism",
          "3,4,5-duoantiprism", "3-4-5 duoantiprism", "teapot duoantiprism"}) {
        const auto named = designNamed(text, 100'000);
        ASSERT_TRUE(std::holds_alternative<PolytopeNameError>(named)) << text;
        EXPECT_EQ(std::get<PolytopeNameError>(named).message,
                  "a duoantiprism is named after two polygons that have at least two sides and are no stars, as in "
                  "3,4-duoantiprism")
            << text;
    }
}

TEST(Duoantiprisms, areLimitedInTheirVerticesOnly) {
    const auto large = designNamed("1000,1000-duoantiprism", 100'000);
    ASSERT_TRUE(std::holds_alternative<PolytopeNameError>(large));
    EXPECT_EQ(std::get<PolytopeNameError>(large).message,
              "the 1000,1000-duoantiprism has 2000000 vertices; at most 100000 are allowed");
    EXPECT_TRUE(std::holds_alternative<PolytopeNameError>(designNamed("3,4-duoantiprism", 23)));
    EXPECT_TRUE(std::holds_alternative<PolytopeDesign>(designNamed("3,4-duoantiprism", 24)));
    // A duoantiprism may have more vertices than a convex hull may have points.
    EXPECT_TRUE(std::holds_alternative<PolytopeDesign>(designNamed("200,250-duoantiprism", 100'000)));
    // A duoantiprism may have a 2-face with more sides than constructions by convex hulls allow.
    const Polytope wide = build(support::designFor("3,1001-duoantiprism"));
    EXPECT_TRUE(wide.convex);
    EXPECT_EQ(wide.vertices.size(), 6006U);
}

}  // namespace
}  // namespace oval4d::polytopes
