#include "slicing/listed_hyperplanes.hpp"

#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "geometry/point_cloud.hpp"
#include "slicing/slicer.hpp"
#include "unit/slicing/support.hpp"

namespace oval4d::slicing {
namespace {

/// Expects that slice i of `all` has the same elements as the only slice of `one`.
void expectSlice(const SliceSet& all, int i, const SliceSet& one) {
    ASSERT_EQ(all.vertexCount(i), one.vertexCount(0));
    ASSERT_EQ(all.edgeCount(i), one.edgeCount(0));
    ASSERT_EQ(all.faceCount(i), one.faceCount(0));
    const std::uint32_t v0 = all.vertexBegin[i], e0 = all.edgeBegin[i], f0 = all.faceBegin[i];
    for (std::uint32_t v = 0; v < one.vertexCount(0); ++v) {
        EXPECT_EQ(all.vertices[v0 + v], one.vertices[v]);
        EXPECT_EQ(all.vertexSource[v0 + v], one.vertexSource[v]);
        if (!one.ballScale.empty()) {
            EXPECT_EQ(all.ballScale[v0 + v], one.ballScale[v]);
            EXPECT_EQ(all.ballOpacity[v0 + v], one.ballOpacity[v]);
        }
    }
    for (std::uint32_t e = 0; e < one.edgeCount(0); ++e) {
        EXPECT_EQ(all.edges[e0 + e], one.edges[e]);
        EXPECT_EQ(all.edgeSource[e0 + e], one.edgeSource[e]);
    }
    for (std::uint32_t f = 0; f < one.faceCount(0); ++f) {
        EXPECT_EQ(all.faceSource[f0 + f], one.faceSource[f]);
        const std::uint32_t c0 = all.cornerBegin[f0 + f], c1 = one.cornerBegin[f];
        ASSERT_EQ(all.cornerBegin[f0 + f + 1] - c0, one.cornerBegin[f + 1] - c1);
        for (std::uint32_t c = 0; c < one.cornerBegin[f + 1] - c1; ++c) {
            EXPECT_EQ(all.corners[c0 + c], one.corners[c1 + c]);
            EXPECT_EQ(all.cornerEdges[c0 + c], one.cornerEdges[c1 + c]);
        }
    }
}

void expectListedSlices(const Object& object, const geometry::Rotation& orientation) {
    // The hyperplanes are not in ascending order. One lies beyond the object, two are close together, and one goes
    // through the middle.
    const double r = infoOf(object).circumradius;
    const std::vector<double> listed{0.3 * r, -0.7 * r, 2 * r, 0, 0.3 * r + 1e-4 * r};
    const geometry::Hyperplanes planes{0, 5, 0.2 * r, 0, listed};
    SliceSet all, one;
    Slicer slicer;
    // The slicer overwrites what the set contained before.
    slicer.sliceWithoutSurfaces(object, orientation, {-3, 7, 0.1}, all);
    slicer.sliceWithoutSurfaces(object, orientation, planes, all);
    ASSERT_EQ(all.planes, planes);
    for (int i = 0; i < planes.count; ++i) {
        SCOPED_TRACE(i);
        EXPECT_EQ(planes.w(i), listed[static_cast<std::size_t>(i)]);
        slicer.sliceWithoutSurfaces(object, orientation, {0, 1, planes.spacing, planes.w(i)}, one);
        expectSlice(all, i, one);
        EXPECT_EQ(all.rotatedVertices, one.rotatedVertices);
    }
    EXPECT_EQ(all.vertexCount(2), 0U);
}

TEST(ListedHyperplanes, CutPolytopesLikeSingleOnes) {
    std::mt19937 random(5);
    for (const char* name : {"24-cell", "small stellated 120-cell"}) {
        SCOPED_TRACE(name);
        expectListedSlices(support::objectOf(support::named(name)), {});
        expectListedSlices(support::objectOf(support::named(name)), support::randomRotation(random));
    }
}

TEST(ListedHyperplanes, CutCloudsLikeSingleOnes) {
    std::mt19937 random(6);
    std::uniform_real_distribution<double> coordinate(-1, 1);
    std::vector<glm::dvec4> points;
    for (int i = 0; i < 200; ++i)
        points.emplace_back(coordinate(random), coordinate(random), coordinate(random), coordinate(random));
    const auto cloud = std::make_shared<const geometry::PointCloud>(
        geometry::makePointCloud("cloud", points, std::vector<double>(points.size())));
    expectListedSlices(Object(cloud), {});
}

}  // namespace
}  // namespace oval4d::slicing
