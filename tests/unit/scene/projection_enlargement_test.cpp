// Tests that the projection of the whole object is put behind the slices that it overlaps in the image.

#include "scene/projection_enlargement.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "scene/composer.hpp"
#include "unit/scene/composed_scene.hpp"
#include "unit/slicing/support.hpp"

namespace oval4d::scene {
namespace {

TEST(ProjectionEnlargement, PutsTheProjectionBehindTheSlicesFromEverywhere) {
    std::mt19937 random(31);
    const auto between = [&](double from, double to) {
        return std::uniform_real_distribution<double>(from, to)(random);
    };
    std::size_t enlarged = 0, inFront = 0;
    for (const char* name : {"5-cell", "24-cell"}) {
        const auto& p = support::named(name);
        for (const ViewTableRow& view : kViews) {
            for (const Viewport viewport : kWindows) {
                Look look;
                look.view = view.value;
                look.orbit = {between(-1.5, 1.5), between(-1, 1), between(0.2, 3)};
                look.projection.kind = random() % 2 == 0 ? ProjectionKind::perspective : ProjectionKind::orthogonal;
                look.thickness = between(0.5, 2);
                const geometry::Rotation orientation = support::randomRotation(random);
                slicing::SliceSet slices;
                slicing::CellComplexSlicer().slice(p, orientation, {-10, 21, p.circumradius / 10}, slices);
                Scene s;
                Composer().compose(support::objectOf(p), orientation, slices, 0, look, viewport, s);
                const double factor = enlargementBehindSlices(s);
                EXPECT_GE(factor, 1);
                enlarged += factor > 1 ? 1 : 0;
                for (std::size_t i = 0; i < s.placements.size(); ++i) {
                    if (!s.placements[i].drawn) continue;
                    const glm::dvec3 toSlice = s.placements[i].position - s.camera.eye;
                    double farthest = 0, reach = 0;
                    for (std::size_t v = slices.vertexBegin[i]; v < slices.vertexBegin[i + 1]; ++v) {
                        const glm::dvec3 vertex = s.scale * slices.vertices[v];
                        reach = std::max(reach, glm::length(vertex));
                        farthest = std::max(farthest, glm::length(toSlice + vertex));
                    }
                    if (reach == 0 || reach >= glm::length(toSlice)) continue;
                    const double halfAngle = std::asin(reach / glm::length(toSlice));
                    for (const glm::dvec3& vertex : s.projection.elements.vertices) {
                        const glm::dvec3 way =
                            s.projectionPlacement.position + s.projection.scale * vertex - s.camera.eye;
                        if (glm::length(way) < s.camera.near) continue;
                        const double cosine = glm::dot(glm::normalize(way), glm::normalize(toSlice));
                        if (cosine < std::cos(halfAngle)) continue;
                        inFront += glm::length(way) < farthest ? 1 : 0;
                        EXPECT_GT(factor * glm::length(way), farthest) << view.name << ", slice " << i;
                    }
                }
            }
        }
    }
    EXPECT_GT(enlarged, 10U);
    EXPECT_GT(inFront, 10U);
}

TEST(ProjectionEnlargement, LeavesTheProjectionBesideTheSlice) {
    Look look;
    look.view = View::single;
    look.projection.kind = ProjectionKind::perspective;
    slicing::SliceSet slices;
    const auto& p = support::named("24-cell");
    slicing::CellComplexSlicer().slice(p, {}, {-10, 21, p.circumradius / 10}, slices);
    Scene s;
    Composer().compose(support::objectOf(p), {}, slices, 0, look, {}, s);
    EXPECT_EQ(enlargementBehindSlices(s), 1);
}

}  // namespace
}  // namespace oval4d::scene
