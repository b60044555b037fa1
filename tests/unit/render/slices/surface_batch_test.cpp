#include "render/slices/surface_batch.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <set>
#include <utility>

#include <glm/geometric.hpp>

#include "fields/formula_field.hpp"
#include "slicing/slicer.hpp"
#include "unit/render/pictures.hpp"

namespace oval4d::render {
namespace {

// The body is half of a box, so that its slices are polyhedra: their level set is flat, and so are their caps.
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

    const Projection projection = Projection::of(scene.camera, scene.viewport);
    const auto positionOf = [&](const SurfaceVertex& vertex) {  // in view coordinates
        const glm::vec3& c = vertex.clip;
        return glm::vec3((c.x - projection.shiftX * c.z) / projection.scaleX,
                         (c.y - projection.shiftY * c.z) / projection.scaleY, -c.z);
    };
    const auto& indices = batch.opaqueIndices();
    std::set<std::uint32_t> used;
    std::size_t compared = 0, different = 0;
    for (std::size_t i = 0; i < batch.fringesBegin(); i += 3) {
        std::array<glm::vec3, 3> corners;
        for (std::size_t k = 0; k < 3; ++k) {
            used.insert(indices[i + k]);
            corners[k] = positionOf(batch.vertices()[indices[i + k]]);
        }
        const glm::vec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
        if (glm::length(normal) < 1e-4F) continue;  // the normal of a narrow triangle is inexact
        ++compared;
        for (std::size_t k = 0; k < 3; ++k)
            different += glm::length(batch.vertices()[indices[i + k]].normal - glm::normalize(normal)) > 0.02F ? 1 : 0;
    }
    const std::size_t triangles = batch.fringesBegin() / 3;
    EXPECT_GT(triangles, 1000U);
    EXPECT_GT(compared, triangles / 2);
    EXPECT_LT(different, compared / 100) << "corners of triangles in one wall with the normal of another";
    EXPECT_LT(used.size(), triangles) << "in a mesh, there are about half as many vertices as triangles";
}

}  // namespace
}  // namespace oval4d::render
