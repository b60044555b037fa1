// Tests of the names of cells that are antiprisms but not uniform.

#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "polytopes/construction/convex_hull.hpp"
#include "polytopes/construction/polyhedra.hpp"
#include "polytopes/polytope.hpp"
#include "unit/polytopes/support.hpp"

namespace oval4d::polytopes {
namespace {

using Deformation = glm::dvec3 (*)(glm::dvec3 point);

// Returns the prism over an antiprism; two of its cells are antiprisms. The antiprism is right and has regular bases of
// circumradius 1. `deformed` then changes its vertices.
Polytope prismOverAntiprism(int sides, double height, Deformation deformed = [](glm::dvec3 point) { return point; }) {
    std::vector<glm::dvec4> points;
    for (int i = 0; i < 2 * sides; ++i) {
        const double angle = std::numbers::pi * i / sides;
        const glm::dvec3 point(std::cos(angle), std::sin(angle), i % 2 == 0 ? height / 2 : -height / 2);
        for (const double w : {-1.0, 1.0}) points.emplace_back(deformed(point), w);
    }
    return hullPolytope("prism", points);
}

// Returns, for each name of a cell, the number of cells with this name.
std::map<std::string, std::uint32_t> namedCells(const Polytope& polytope) {
    std::map<std::string, std::uint32_t> cells;
    for (const CellType& type : polytope.cellTypes) cells[type.name] += type.cells;
    return cells;
}

std::string antiprismOver(int sides) { return adjectiveOf({sides, 1}) + " antiprism"; }

TEST(AntiprismCells, ofAnyHeightHaveNames) {
    for (const int sides : {3, 4, 5, 6, 17}) {
        for (const double height : {0.25, 1.0, 3.0}) {
            SCOPED_TRACE(antiprismOver(sides) + " of height " + std::to_string(height));
            const Polytope p = prismOverAntiprism(sides, height);
            EXPECT_EQ(namedCells(p)[antiprismOver(sides)], 2U);
            // The antiprisms keep their names if the coordinates are rounded to three decimals, as in a file.
            std::vector<glm::dvec4> rounded = p.vertices;
            for (glm::dvec4& v : rounded) v = glm::round(v * 1000.0) / 1000.0;
            EXPECT_EQ(namedCells(makePolytope("rounded", rounded, p.faces, p.cells)), namedCells(p));
        }
    }
    EXPECT_EQ(namedCells(prismOverAntiprism(3, std::numbers::sqrt2))["octahedron"], 2U) << "all edges are equal";
}

TEST(AntiprismCells, areRightAndHaveRegularBasesOfEqualSize) {
    const std::map<std::string, Deformation> deformations{
        {"oblique", [](glm::dvec3 v) { return glm::dvec3(v.x + 0.3 * v.z, v.y, v.z); }},
        {"stretched", [](glm::dvec3 v) { return glm::dvec3(1.3 * v.x, v.y, v.z); }},
        {"twisted",
         [](glm::dvec3 v) {
             return v.z < 0 ? v
                            : glm::dvec3(std::cos(0.1) * v.x - std::sin(0.1) * v.y,
                                         std::sin(0.1) * v.x + std::cos(0.1) * v.y, v.z);
         }},
        {"with a smaller base", [](glm::dvec3 v) { return v.z < 0 ? v : glm::dvec3(0.8 * v.x, 0.8 * v.y, v.z); }}};
    for (const int sides : {3, 4, 5, 6}) {
        for (const auto& [how, deformed] : deformations) {
            SCOPED_TRACE(antiprismOver(sides) + ", " + how);
            auto cells = namedCells(prismOverAntiprism(sides, 1, deformed));
            EXPECT_EQ(cells["cell of " + std::to_string(2 * sides + 2) + " faces"], 2U);
            EXPECT_FALSE(cells.contains(antiprismOver(sides)));
        }
    }
}

TEST(AntiprismCells, ofDuoantiprismsHaveNames) {
    using Cells = std::map<std::string, std::uint32_t>;
    EXPECT_EQ(namedCells(support::named("3,4-duoantiprism")),
              (Cells{{"square antiprism", 6}, {"triangular antiprism", 8}, {"tetrahedron", 24}}));
    EXPECT_EQ(namedCells(support::named("5,5-duoantiprism")),
              (Cells{{"pentagonal antiprism", 20}, {"tetrahedron", 50}}));
    EXPECT_EQ(namedCells(support::named("2,7-duoantiprism")),
              (Cells{{"heptagonal antiprism", 4}, {"tetrahedron", 42}}));
}

}  // namespace
}  // namespace oval4d::polytopes
