#include "render/slices/surface_batch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <set>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "fields/formula_field.hpp"
#include "slicing/slicer.hpp"
#include "unit/render/pictures.hpp"

namespace oval4d::render {
namespace {

// Caps in the same wall share vertices, but caps in different walls do not. The body is half of a box, so its slices
// are polyhedra: their level set and their caps are flat.
TEST(SurfaceBatch, SharesVerticesInEachWallButNotBetweenWalls) {
    auto field = fields::fieldFromFormula("test", "x + y/2 + w/3");
    ASSERT_TRUE(field);
    const slicing::Object object = std::make_shared<const fields::Field>(std::move(*field));
    const geometry::Rotation orientation = randomRotation(7);
    const geometry::Hyperplanes planes{-2, 5, 0.5};
    const scene::Look look;
    slicing::SurfaceDetail detail;
    slicing::setUniformDetail(slicing::infoOf(object).circumradius, planes, slicing::Quality::full, detail);
    slicing::SliceSet slices;
    slicing::Slicer().slice(object, orientation, planes, look.field, detail, slices);
    scene::Scene scene;
    scene::Composer().compose(object, orientation, slices, 0, look, {1280, 720}, scene);
    SurfaceBatch batch;
    DepthRange depths;
    batch.collect(scene, depths);

    const ViewProjection projection = ViewProjection::fromCamera(scene.camera, scene.viewport);
    const auto positionOf = [&](const SurfaceVertex& vertex) {  // returns the position of a vertex in view coordinates
        const glm::vec3& c = vertex.clip;
        return glm::vec3((c.x - projection.shiftX * c.z) / projection.scaleX,
                         (c.y - projection.shiftY * c.z) / projection.scaleY, -c.z);
    };
    const auto& indices = batch.opaqueIndices();
    std::set<std::uint32_t> used;
    std::size_t compared = 0, different = 0;
    for (std::size_t i = 0; i < batch.antialiasingFringesBegin(); i += 3) {
        std::array<glm::vec3, 3> corners;
        for (std::size_t k = 0; k < 3; ++k) {
            used.insert(indices[i + k]);
            corners[k] = positionOf(batch.vertices()[indices[i + k]]);
        }
        const glm::vec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
        if (glm::length(normal) < 1e-4F) continue;  // skips narrow triangles, whose normals are inexact
        ++compared;
        for (std::size_t k = 0; k < 3; ++k)
            different += glm::length(batch.vertices()[indices[i + k]].normal - glm::normalize(normal)) > 0.02F ? 1 : 0;
    }
    const std::size_t triangles = batch.antialiasingFringesBegin() / 3;
    EXPECT_GT(triangles, 1000U);
    EXPECT_GT(compared, triangles / 2);
    EXPECT_LT(different, compared / 100) << "corners of triangles in one wall with the normal of another";
    EXPECT_LT(used.size(), triangles) << "in a mesh, there are about half as many vertices as triangles";
}

TEST(SurfaceBatch, HasTheSurfaceOfTheFocusSliceInTheProjectionApartFromThoseOfTheSlices) {
    auto field = fields::fieldFromFormula("test", "x^2 + y^2 + z^2 + w^2 - 2");
    ASSERT_TRUE(field);
    const slicing::Object object = std::make_shared<const fields::Field>(std::move(*field));
    const geometry::Hyperplanes planes{-2, 5, 0.5};
    scene::Look look;
    look.projection.kind = scene::ProjectionKind::perspective;
    const double radius = slicing::infoOf(object).circumradius;
    slicing::SurfaceDetail detail;
    slicing::setUniformDetail(radius, planes, slicing::Quality::draft, detail);
    slicing::SliceSet slices;
    slicing::Slicer().slice(object, {}, planes, look.field, detail, slices);
    scene::Scene scene;
    scene::Composer composer;
    composer.compose(object, {}, slices, 1, look, {1280, 720}, scene);
    ASSERT_TRUE(scene.projection.focusSurface);
    const auto [slice, scale] = *scene.projection.focusSurface;
    EXPECT_EQ(slice, 3U);
    const double eye = look.projection.eye * radius;
    EXPECT_NEAR(scale, scene.projection.scale * eye / (eye - 0.5), 1e-12);

    SurfaceBatch batch;
    DepthRange depths;
    const auto clipPoints = [&](SurfaceBatch::SliceSelection selection) {
        batch.collect(scene, depths, selection);
        std::set<std::array<float, 3>> points;
        for (const SurfaceVertex& vertex : batch.vertices()) {
            // Whether the vertex is on the outer side of a fringe, where the opacity is 0.
            const bool isOuterRim = vertex.color >> 24U == 0;
            if (!isOuterRim) points.insert(std::array{vertex.clip.x, vertex.clip.y, vertex.clip.z});
        }
        return points;
    };
    const auto ofSlices = clipPoints(SurfaceBatch::SliceSelection::slices);
    EXPECT_EQ(batch.slicesFarToNear().size(), 5U);
    const auto ofProjection = clipPoints(SurfaceBatch::SliceSelection::projection);
    EXPECT_EQ(batch.slicesFarToNear().size(), 1U);
    const ViewProjection projection = ViewProjection::fromCamera(scene.camera, scene.viewport);
    const glm::dmat4 toView = scene.camera.view();
    std::set<std::array<float, 3>> expected;
    for (const glm::vec3& point : slices.surfaces[3].points) {
        const glm::dvec3 world = scene.projectionPlacement.position + scale * glm::dvec3(point);
        const glm::vec3 clip = projection.clipXyw(glm::vec3(toView * glm::dvec4(world, 1)));
        expected.insert(std::array{clip.x, clip.y, clip.z});
    }
    std::size_t added = 0;
    for (const std::array<float, 3>& point : ofProjection) {
        EXPECT_FALSE(ofSlices.contains(point));
        ++added;
        const auto distance = [&](const std::array<float, 3>& other) {
            return glm::distance(glm::vec3(other[0], other[1], other[2]), glm::vec3(point[0], point[1], point[2]));
        };
        if (added % 16 == 1) {
            EXPECT_LT(distance(*std::ranges::min_element(expected, {}, distance)), 1e-3F);
        }
    }
    EXPECT_GT(added, expected.size() / 4) << "about half of the points are on the side toward the eye";

    look.parts.faces = false;
    composer.compose(object, {}, slices, 1, look, {1280, 720}, scene);
    EXPECT_FALSE(scene.projection.focusSurface);
    EXPECT_TRUE(clipPoints(SurfaceBatch::SliceSelection::projection).empty());
    EXPECT_TRUE(batch.slicesFarToNear().empty());
}

}  // namespace
}  // namespace oval4d::render
