#include "slicing/element_shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "geometry/point_cloud.hpp"
#include "unit/slicing/support.hpp"

namespace oval4d::slicing {
namespace {

using support::shared;

// The shape of an element is congruent to the element: all distances between its vertices stay the same.
TEST(ElementShape, hasTheDistancesOfTheElement) {
    std::mt19937 random(31);
    for (const char* name : {"5-cell", "tesseract", "3,5-duoprism", "small stellated 120-cell"}) {
        const auto polytope = shared(name);
        const Object object = polytope;
        const auto edges = static_cast<std::uint32_t>(polytope->edges.size());
        const double tolerance = 1e-12 * polytope->circumradius;
        for (const auto& [kindName, kind] : kElementKinds) {
            SCOPED_TRACE(std::string(name) + ", " + std::string(kindName));
            const Element element{kind, random() % elementCount(object, kind)};
            SliceSet shape;
            writeElementAsSlice(object, element, support::randomRotation(random), shape);
            ASSERT_EQ(shape.planes.count, 1);
            PartsShowingElement sources;
            findPartsShowing(object, element, sources);
            ASSERT_EQ(shape.vertices.size(), sources.ownVertices.size());
            for (std::size_t i = 0; i < shape.vertices.size(); ++i) {
                EXPECT_EQ(shape.vertexSource[i], edges + sources.ownVertices[i]);
                for (std::size_t j = 0; j < i; ++j) {
                    const double distance = glm::distance(polytope->vertices[sources.ownVertices[i]],
                                                          polytope->vertices[sources.ownVertices[j]]);
                    EXPECT_NEAR(glm::distance(shape.vertices[i], shape.vertices[j]), distance, tolerance);
                }
            }
            EXPECT_EQ(shape.faceCount(0), kind == ElementKind::cell ? polytope->cells[element.index].size() : 0);
            if (kind == ElementKind::edge) {
                EXPECT_EQ(shape.edgeCount(0), 1U);
            } else if (kind == ElementKind::face) {
                EXPECT_EQ(shape.edgeCount(0), polytope->faces[element.index].size());
            }
        }
    }
}

// The 2-faces in the shape of a cell are oriented outward and joined along the cell's edges, so that they enclose the
// volume of the cell.
TEST(ElementShape, ofACellEnclosesItsVolume) {
    std::mt19937 random(32);
    for (const char* name : {"5-cell", "snub 24-cell", "3,5-duoprism", "small stellated 120-cell"}) {
        const Object object = shared(name);
        std::vector<glm::dvec4> normals;
        std::vector<double> offsets;
        findCellHyperplanes(object, normals, offsets);  // the length of a normal is six times the volume of the cell
        for (int round = 0; round < 5; ++round) {
            const std::size_t cell = random() % normals.size();
            SCOPED_TRACE(std::string(name) + ", cell " + std::to_string(cell));
            SliceSet shape;
            writeElementAsSlice(object, {ElementKind::cell, cell}, support::randomRotation(random), shape);
            const double volume = glm::length(normals[cell]) / 6;
            EXPECT_NEAR(support::volumeOf(shape, 0), volume, 1e-9 * volume);
            for (std::uint32_t f = 0; f < shape.faceCount(0); ++f) {
                const std::uint32_t begin = shape.cornerBegin[f], count = shape.cornerBegin[f + 1] - begin;
                for (std::uint32_t i = 0; i < count; ++i) {
                    const auto ends = std::minmax(shape.corners[begin + i], shape.corners[begin + (i + 1) % count]);
                    auto edge = shape.edges[shape.cornerEdges[begin + i]];
                    std::ranges::sort(edge);
                    EXPECT_EQ(edge, (std::array{ends.first, ends.second}));
                }
            }
        }
    }
}

TEST(ElementShape, ofAPointIsThisPoint) {
    const auto cloud = std::make_shared<const geometry::PointCloud>(
        geometry::makePointCloud("two", {glm::dvec4(1, 2, 3, 4), glm::dvec4(0, 0, 0, 2)}, {0, 0}));
    SliceSet shape;
    writeElementAsSlice(Object(cloud), {ElementKind::vertex, 0}, {}, shape);
    ASSERT_EQ(shape.vertices.size(), 1U);
    EXPECT_NEAR(glm::length(shape.vertices[0]), 0, 1e-12);
    EXPECT_NEAR(shape.planes.w(0), std::sqrt(30), 1e-12);
    EXPECT_EQ(shape.vertexSource[0], 0U);
}

}  // namespace
}  // namespace oval4d::slicing
