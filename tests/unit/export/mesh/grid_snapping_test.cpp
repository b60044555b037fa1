#include "export/mesh/grid_snapping.hpp"

#include <array>
#include <cmath>
#include <random>
#include <set>
#include <stdexcept>
#include <vector>

#include "slicing/closed_surfaces/closed_surface_slicer.hpp"
#include "unit/export/support.hpp"
#include "unit/slicing/field_support.hpp"

namespace {

using namespace oval4d;
using namespace oval4d::support;
using namespace oval4d::exports;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

// Returns the closed surface of a random function, many of whose points are close together.
slicing::ClosedSurface waves(std::mt19937& random, int cells) {
    std::normal_distribution<double> normal;
    std::array<glm::dvec4, 4> waves{};
    double slope = 0;
    for (auto& wave : waves) {
        wave = 3.0 * glm::dvec4(normal(random), normal(random), normal(random), normal(random));
        slope += glm::length(wave);
    }
    const auto f = [&](const glm::dvec4& p) {
        double sum = 0;
        for (const auto& wave : waves) sum += std::sin(glm::dot(wave, p) + wave.x);
        return sum;
    };
    const fields::Field field = slicing::testField(f, slope, {glm::dvec4(-1), glm::dvec4(1)});
    slicing::ClosedSurface surface;
    slicing::ClosedSurfaceSlicer slicer(field, randomRotation(random), cells);
    EXPECT_TRUE(slicer.slice(0.1, {.level = 0.2}, surface));
    return surface;
}

TEST(GridSnapping, keepsSurfacesClosedManifolds) {
    std::mt19937 random(50);
    for (int trial = 0; trial < 6; ++trial) {
        const slicing::ClosedSurface surface = waves(random, 12);
        ASSERT_GT(surface.triangles.size(), 100U);
        std::vector<glm::dvec3> points;
        for (const glm::dvec3& point : surface.points) points.push_back(10.0 * point);
        double volume = 0;
        for (const auto& [a, b, c] : surface.triangles)
            volume += glm::dot(points[a], glm::cross(points[b], points[c])) / 6;
        for (const double size : {60.0, 10'000.0}) {  // with the second size, a step is 1/16 of the cells of the
                                                      // surface
            const RoundingGrid grid(size, size);
            const SnappedSurface snapped = snapSurface(points, surface.triangles, grid, unhurried());
            expectPrintable(snapped.mesh);
            EXPECT_TRUE(isClosedManifold(snapped.mesh));
            EXPECT_LE(snapped.mesh.triangles.size(), surface.triangles.size());
            if (size > 100) {
                EXPECT_LT(snapped.mesh.triangles.size(), surface.triangles.size()) << "some edges are collapsed";
            }
            EXPECT_NEAR(volumeOf(snapped.mesh) / volume, 1, size < 100 ? 1e-4 : 0.03);
            ASSERT_EQ(snapped.source.size(), snapped.mesh.points.size());
            for (std::size_t p = 0; p < snapped.source.size(); ++p) {
                EXPECT_EQ(grid.snap(snapped.mesh.points[p]), snapped.mesh.points[p]);
                EXPECT_LT(glm::distance(snapped.mesh.points[p], points[snapped.source[p]]), 8 * grid.step());
            }
        }
    }
}

// On a grid for doubles, rounding hardly changes the volume.
TEST(GridSnapping, keepsTheVolumeOnAGridForDoubles) {
    std::mt19937 random(51);
    const double size = 60, extent = 1500;
    const RoundingGrid grid = RoundingGrid::forDoublePrecision(size, extent);
    EXPECT_LE(grid.step(), size * 0x1p-39);
    EXPECT_EQ(std::log2(grid.step()), std::round(std::log2(grid.step())));
    for (int trial = 0; trial < 6; ++trial) {
        const slicing::ClosedSurface surface = waves(random, 12);
        std::vector<glm::dvec3> points;
        for (const glm::dvec3& point : surface.points) points.push_back(10.0 * point);
        const SnappedSurface snapped = snapSurface(points, surface.triangles, grid, unhurried());
        EXPECT_TRUE(isClosedManifold(snapped.mesh));
        std::set<std::array<double, 3>> places;
        for (const glm::dvec3& p : snapped.mesh.points) places.insert({p.x, p.y, p.z});
        EXPECT_EQ(places.size(), snapped.mesh.points.size());
        double volume = 0;
        for (const auto& [a, b, c] : surface.triangles)
            volume += glm::dot(points[a], glm::cross(points[b], points[c])) / 6;
        EXPECT_NEAR(volumeOf(snapped.mesh) / volume, 1, 1e-10);
        const glm::dvec3 shift = grid.snap(glm::dvec3(extent / 3, 0, 0));
        for (const glm::dvec3& p : snapped.mesh.points) EXPECT_EQ(p + shift - shift, p) << "sums are exact";
    }
}

// If two tetrahedra share a corner or an edge, each gets its own copy of the shared points.
TEST(GridSnapping, separatesWhatTouches) {
    const std::vector<glm::dvec3> points{{0, 0, 0},  {1, 0, 0},  {0, 1, 0},  {0, 0, 1},
                                         {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}, {0, -1, -1}};
    const Triangles first{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    const RoundingGrid grid(60, 60);
    for (const Triangles& second : {Triangles{{0, 4, 5}, {0, 6, 4}, {0, 5, 6}, {4, 6, 5}},
                                    Triangles{{0, 5, 1}, {0, 1, 7}, {0, 7, 5}, {1, 5, 7}}}) {
        Triangles both = first;
        both.insert(both.end(), second.begin(), second.end());
        const SnappedSurface snapped = snapSurface(points, both, grid, unhurried());
        EXPECT_EQ(snapped.mesh.triangles.size(), 8U);
        EXPECT_EQ(snapped.mesh.points.size(), 8U);
        EXPECT_TRUE(isClosedManifold(snapped.mesh));
        std::set<Key> places;
        for (const glm::dvec3& p : snapped.mesh.points) places.insert({float(p.x), float(p.y), float(p.z)});
        EXPECT_EQ(places.size(), 8U);
    }
}

TEST(GridSnapping, leavesOutSpecksAndRefusesOpenSurfaces) {
    std::vector<glm::dvec3> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int i = 0; i < 4; ++i) points.push_back(5.0 + 1e-4 * points[static_cast<std::size_t>(i)]);
    Triangles triangles{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}, {4, 6, 5}, {4, 5, 7}, {4, 7, 6}, {5, 6, 7}};
    const RoundingGrid grid(60, 60);
    EXPECT_EQ(snapSurface(points, triangles, grid, unhurried()).mesh.triangles.size(), 4U);
    triangles.pop_back();
    EXPECT_THROW(snapSurface(points, triangles, grid, unhurried()), std::invalid_argument);
    const ExportBudget late({.time = std::chrono::duration<double>(0)}, {});
    triangles.push_back({5, 6, 7});
    EXPECT_THROW(snapSurface(points, triangles, grid, late), ExportRefused);
}

// A triangle without area is removed by flipping an edge. Here, a tetrahedron has an additional point in the middle of
// an edge, and a triangle without area there.
TEST(GridSnapping, flipsTrianglesWithoutArea) {
    const std::vector<glm::dvec3> points{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {1, 0, 0}};
    const Triangles triangles{{0, 2, 1}, {0, 4, 3}, {4, 1, 3}, {0, 3, 2}, {1, 2, 3}, {0, 1, 4}};
    for (const RoundingGrid& grid : {RoundingGrid(60, 60), RoundingGrid::forDoublePrecision(60, 60)}) {
        const SnappedSurface snapped = snapSurface(points, triangles, grid, unhurried());
        EXPECT_TRUE(isClosedManifold(snapped.mesh));
        EXPECT_EQ(snapped.mesh.triangles.size(), 6U);
        for (const auto& triangle : snapped.mesh.triangles)
            EXPECT_GT(glm::length(doubleAreaNormalOf(snapped.mesh, triangle)), 0);
        EXPECT_NEAR(volumeOf(snapped.mesh), 8.0 / 6, 1e-9);
    }
}

}  // namespace
