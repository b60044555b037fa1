// Elements turned toward +w, and the heights of vertices.

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "geometry/point_cloud.hpp"
#include "slicing/element.hpp"
#include "unit/slicing/support.hpp"

namespace oval4d::slicing {
namespace {

using polytopes::Polytope;
using support::shared;

const glm::dvec4 kW(0, 0, 0, 1);

// Returns w of the element's vertices after rotation.
std::vector<double> heightsOf(const Polytope& p, const Element& element, const geometry::Rotation& orientation) {
    std::set<std::uint32_t> vertices;
    switch (element.kind) {
        case ElementKind::vertex:
            vertices.insert(static_cast<std::uint32_t>(element.index));
            break;
        case ElementKind::edge:
            vertices.insert(p.edges[element.index].begin(), p.edges[element.index].end());
            break;
        case ElementKind::face:
            for (const auto v : p.faces[element.index]) vertices.insert(v);
            break;
        case ElementKind::cell:
            for (const auto face : p.cells[element.index]) {
                for (const auto v : p.faces[face]) vertices.insert(v);
            }
    }
    std::vector<double> heights;
    for (const auto v : vertices) heights.push_back(orientation(p.vertices[v]).w);
    return heights;
}

geometry::Rotation turnedTo(const Object& object, const Element& element, const geometry::Rotation& from) {
    return wayToW(object, element, from) * from;
}

TEST(Elements, LieInOneHyperplaneOnceTheyPointToW) {
    std::mt19937 random(11);
    for (const char* name : {"5-cell", "tesseract", "24-cell", "rectified 5-cell", "snub 24-cell", "3,5-duoprism",
                             "small stellated 120-cell", "dual of rectified tesseract"}) {
        const auto polytope = shared(name);
        const Object object = polytope;
        for (const auto& [kindName, kind] : kElementKinds) {
            ASSERT_EQ(elementCount(object, kind), elementCounts(object).at(static_cast<std::size_t>(kind)));
            for (int round = 0; round < 10; ++round) {
                const Element element{kind, random() % elementCount(object, kind)};
                const auto orientation = turnedTo(object, element, support::randomRotation(random));
                const auto heights = heightsOf(*polytope, element, orientation);
                const auto [least, most] = std::ranges::minmax(heights);
                EXPECT_LT(most - least, 1e-12 * polytope->circumradius) << name << ", " << kindName;
                if (!polytope->convex) continue;
                EXPECT_GT(least, 0) << name << ", " << kindName;
                if (kind != ElementKind::cell) continue;
                EXPECT_NEAR(most, rangeOfW(object, orientation).second, 1e-12 * polytope->circumradius)
                    << "a cell of a convex polytope supports it";
            }
        }
    }
}

// Objects from files have rounded coordinates. The rounding errors of the vertices are not directions of the element.
TEST(Elements, LieInOneHyperplaneToWithinTheRoundingOfTheirVertices) {
    std::mt19937 random(48);
    for (const char* name : {"5-cell", "tesseract", "24-cell", "3,3-duoprism", "3,5-duoprism", "snub 24-cell"}) {
        for (const double unit : {1e-3, 1e-4, 1e-5}) {
            const auto exact = shared(name);
            const geometry::Rotation turned = support::randomRotation(random);
            std::vector<glm::dvec4> vertices;
            for (const glm::dvec4& v : exact->vertices) vertices.push_back(glm::round(turned(v) / unit) * unit);
            const auto rounded = std::make_shared<const Polytope>(
                polytopes::makePolytope("rounded", std::move(vertices), exact->faces, exact->cells));
            const Object object = rounded;
            for (const auto& [kindName, kind] : kElementKinds) {
                for (std::size_t i = 0; i < elementCount(object, kind); ++i) {
                    const auto heights = heightsOf(*rounded, {kind, i}, turnedTo(object, {kind, i}, turned));
                    const auto [least, most] = std::ranges::minmax(heights);
                    ASSERT_LE(most - least, 10 * unit) << name << ' ' << unit << ' ' << kindName << ' ' << i;
                }
            }
        }
    }
}

TEST(Elements, ThroughTheOriginTurnTheShortestWay) {
    // A point at the origin has no direction of its own, so it is already where it should be.
    const Object object = std::make_shared<const geometry::PointCloud>(
        geometry::makePointCloud("points", {{0, 0, 0, 0}, {1, 0, 0, 0}}, {0, 0}));
    std::mt19937 random(12);
    const auto from = support::randomRotation(random);
    const glm::dvec4 direction = directionOf(object, {ElementKind::vertex, 0}, from.inverse()(kW));
    EXPECT_LT(glm::distance(glm::normalize(direction), from.inverse()(kW)), 1e-12);
    EXPECT_LT(glm::distance(glm::normalize(directionOf(object, {ElementKind::vertex, 1}, kW)), {1, 0, 0, 0}), 1e-12);
    EXPECT_EQ(elementCount(object, ElementKind::cell), 0U);
    EXPECT_FALSE(elementToTurnTo(object, ElementKind::cell, from));
}

TEST(Elements, ClosestToWIsChosenAndThenTheNext) {
    const auto polytope = shared("24-cell");
    const Object object = polytope;
    std::mt19937 random(13);
    for (const auto& [kindName, kind] : kElementKinds) {
        const auto from = support::randomRotation(random);
        const auto closest = elementToTurnTo(object, kind, from);
        ASSERT_TRUE(closest);
        const auto cosineOf = [&](std::size_t i) { return glm::normalize(from(directionOf(object, {kind, i}, kW))).w; };
        for (std::size_t i = 0; i < elementCount(object, kind); ++i)
            EXPECT_LE(cosineOf(i), cosineOf(closest->index) + 1e-9) << kindName;
        std::set<std::size_t> visited;
        geometry::Rotation orientation = from;
        for (std::size_t i = 0; i < elementCount(object, kind); ++i) {
            const auto next = elementToTurnTo(object, kind, orientation);
            ASSERT_TRUE(next);
            visited.insert(next->index);
            orientation = turnedTo(object, *next, orientation);
        }
        EXPECT_EQ(visited.size(), elementCount(object, kind)) << "repetition visits every " << kindName;
    }
}

// Every face of a 24-cell is in two cells, has three edges and three vertices; every vertex is in six cells (Coxeter,
// Regular Polytopes, table I).
TEST(Elements, AreChosenAmongThoseAtAnother) {
    const Object object = shared("24-cell");
    std::mt19937 random(14);
    struct {
        ElementKind lit, kind;
        std::size_t count;
    } const rows[] = {{ElementKind::face, ElementKind::cell, 2},   {ElementKind::face, ElementKind::edge, 3},
                      {ElementKind::face, ElementKind::vertex, 3}, {ElementKind::face, ElementKind::face, 1},
                      {ElementKind::vertex, ElementKind::cell, 6}, {ElementKind::cell, ElementKind::vertex, 6},
                      {ElementKind::edge, ElementKind::face, 3},   {ElementKind::cell, ElementKind::face, 8}};
    for (const auto& [litKind, kind, count] : rows) {
        const Element lit{litKind, random() % elementCount(object, litKind)};
        geometry::Rotation orientation = support::randomRotation(random);
        std::set<std::size_t> visited;
        for (std::size_t i = 0; i < 2 * count; ++i) {
            const auto next = elementToTurnTo(object, kind, orientation, lit);
            ASSERT_TRUE(next);
            visited.insert(next->index);
            orientation = turnedTo(object, *next, orientation);
        }
        EXPECT_EQ(visited.size(), count);
        if (kind == litKind) {
            EXPECT_EQ(*visited.begin(), lit.index);
        }
    }
}

// Coxeter, Regular Polytopes, table V: the distances of the 600-cell's vertices from one of them.
TEST(VertexHeights, AreThoseOfCoxetersSections) {
    struct Case {
        const char* name;
        ElementKind kind;
        std::size_t count;
    };
    for (const auto& [name, kind, count] :
         {Case{"600-cell", ElementKind::vertex, 9}, Case{"120-cell", ElementKind::cell, 15},
          Case{"24-cell", ElementKind::vertex, 5}, Case{"24-cell", ElementKind::cell, 3},
          Case{"tesseract", ElementKind::vertex, 5}, Case{"tesseract", ElementKind::cell, 2},
          Case{"16-cell", ElementKind::vertex, 3}, Case{"16-cell", ElementKind::cell, 2},
          Case{"5-cell", ElementKind::vertex, 2}}) {
        const Object object = shared(name);
        std::mt19937 random(14);
        const auto orientation = turnedTo(object, {kind, 0}, support::randomRotation(random));
        std::vector<double> up, down;
        for (auto w = nextVertexHeight(object, orientation, -1e9, true); w;
             w = nextVertexHeight(object, orientation, *w, true))
            up.push_back(*w);
        for (auto w = nextVertexHeight(object, orientation, 1e9, false); w;
             w = nextVertexHeight(object, orientation, *w, false))
            down.push_back(*w);
        EXPECT_EQ(up.size(), count) << name;
        ASSERT_EQ(down.size(), up.size()) << name;
        std::ranges::reverse(down);
        for (std::size_t i = 0; i < up.size(); ++i) EXPECT_NEAR(up[i], down[i], 1e-9) << name;
        const auto [least, most] = rangeOfW(object, orientation);
        EXPECT_NEAR(up.front(), least, 1e-9);
        EXPECT_NEAR(up.back(), most, 1e-9);
    }
}

}  // namespace
}  // namespace oval4d::slicing
