#include "slicing/surfaces/surface_measurements.hpp"

#include <array>
#include <cstdint>
#include <utility>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

namespace oval4d::slicing {
namespace {

// Adds to `surface` a cube with this lower corner and this side. If `inward` is true, the surface of the cube faces
// inward.
void addCube(ClosedSurface& surface, const glm::dvec3& corner, double side, bool inward = false) {
    const auto first = static_cast<std::uint32_t>(surface.points.size());
    for (int i = 0; i < 8; ++i) surface.points.push_back(corner + side * glm::dvec3(i & 1, i >> 1 & 1, i >> 2));
    constexpr std::array<std::array<std::uint32_t, 4>, 6> kFaces{
        {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
    for (const auto& [a, b, c, d] : kFaces) {
        std::array<std::array<std::uint32_t, 3>, 2> halves{{{a, b, c}, {a, c, d}}};
        for (auto [p, q, r] : halves) {
            if (inward) std::swap(q, r);
            surface.triangles.push_back({first + p, first + q, first + r});
        }
    }
    surface.firstCap = surface.triangles.size();
}

TEST(SurfaceMeasurements, OfACube) {
    ClosedSurface surface;
    addCube(surface, {1, 2, 3}, 2);
    surface.firstCap = 10;  // the first cap triangle: one of the cube's sides is a cap
    const auto measured = measureSurface(surface);
    EXPECT_NEAR(measured.volume, 8, 1e-12);
    EXPECT_NEAR(measured.area, 20, 1e-12);
    EXPECT_NEAR(measured.capArea, 4, 1e-12);
    ASSERT_TRUE(measured.centroid);
    EXPECT_NEAR(glm::distance(*measured.centroid, glm::dvec3(2, 3, 4)), 0, 1e-12);
    EXPECT_EQ(measured.components, 1U);
    EXPECT_EQ(measured.euler, 2);
}

TEST(SurfaceMeasurements, CavitiesAreNoComponents) {
    ClosedSurface surface;
    addCube(surface, {0, 0, 0}, 4);
    addCube(surface, {1, 1, 1}, 2, true);
    addCube(surface, {1.5, 1.5, 1.5}, 1);  // a smaller body in the cavity
    addCube(surface, {1e6, 0, 0}, 1e-3);   // a small body far away
    const auto measured = measureSurface(surface);
    EXPECT_NEAR(measured.volume, 64 - 8 + 1, 1e-6);
    EXPECT_EQ(measured.components, 3U);
    EXPECT_EQ(measured.euler, 8);
}

TEST(SurfaceMeasurements, OfNothing) {
    const auto measured = measureSurface(ClosedSurface{});
    EXPECT_EQ(measured.volume, 0);
    EXPECT_EQ(measured.components, 0U);
    EXPECT_EQ(measured.euler, 0);
    EXPECT_FALSE(measured.centroid);
    EXPECT_EQ(measureSurface(SliceSurface{}, 0).components, 0U);
}

TEST(SurfaceMeasurements, OfOneLevelOfSeveral) {
    ClosedSurface cubes;
    addCube(cubes, {0, 0, 0}, 3);
    addCube(cubes, {1, 1, 1}, 1);
    SliceSurface surface;
    for (const glm::dvec3& point : cubes.points) surface.points.emplace_back(point);
    surface.triangles = cubes.triangles;
    surface.levelAndCap.assign(24, 1);
    for (std::size_t t = 8; t < 12; ++t) surface.levelAndCap[t] = 1 | SliceSurface::kCap;
    for (std::size_t t = 12; t < 24; ++t) surface.levelAndCap[t] = 2;
    const auto outer = measureSurface(surface, 1), inner = measureSurface(surface, 2);
    EXPECT_NEAR(outer.volume, 27, 1e-6);
    EXPECT_NEAR(outer.area, 36, 1e-6);
    EXPECT_NEAR(outer.capArea, 18, 1e-6);
    EXPECT_NEAR(inner.volume, 1, 1e-6);
    EXPECT_EQ(inner.capArea, 0);
    EXPECT_EQ(inner.euler, 2);
    EXPECT_EQ(measureSurface(surface, 0).volume, 0);
}

}  // namespace
}  // namespace oval4d::slicing
