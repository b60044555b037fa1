// Tests of drawings of slices.

#include <cstddef>
#include <memory>
#include <variant>

#include <gtest/gtest.h>

#include "export/drawing/slices_drawing.hpp"
#include "geometry/point_cloud.hpp"
#include "scene/composer.hpp"
#include "slicing/slicer.hpp"
#include "unit/export/support.hpp"
#include "unit/slicing/support.hpp"

namespace {

using namespace oval4d;

// Returns the number of disks (balls) in the drawing of a scene's slices.
std::size_t disks(const scene::Scene& scene, const slicing::Object& object) {
    std::size_t count = 0;
    for (const exports::ShapeGroup& group : exports::drawSlices(scene, object, support::unhurried()).groups) {
        if (!group.id.starts_with("slice_")) continue;
        for (const exports::DrawnShape& shape : group.shapes)
            count += std::holds_alternative<exports::Disk>(shape) ? 1 : 0;
    }
    return count;
}

TEST(SlicesDrawing, showsThePointsOfACloudWithoutBalls) {
    const slicing::Object cloud = std::make_shared<const geometry::PointCloud>(
        geometry::makePointCloud("dots", {{1, 0, 0, 0}, {0, 1, 0, 0.2}, {0, 0, -0.5, 0.5}}, {0, 0, 0.1}));
    slicing::SliceSet slices;
    slicing::Slicer().slice(cloud, {}, {-1, 3, 0.5}, {}, {}, slices);
    for (const bool balls : {true, false}) {
        for (const bool bars : {true, false}) {
            scene::Look look;
            look.parts.balls = balls;
            look.parts.bars = bars;
            scene::Scene scene;
            scene::Composer().compose(cloud, {}, slices, 0, look, {}, scene);
            EXPECT_EQ(disks(scene, cloud), 3U) << balls << bars;
        }
    }
}

TEST(SlicesDrawing, showsVerticesWithoutBarsWhereBarsAreShown) {
    slicing::SliceSet slices;  // two vertices with an edge between them, and one without edges
    slices.planes = {0, 1, 1};
    slices.vertexBegin = {0, 3};
    slices.vertices = {{-0.5, 0, 0}, {0.5, 0, 0}, {0, 0.5, 0}};
    slices.vertexSource = {0, 0, 0};
    slices.edgeBegin = {0, 1};
    slices.edges = {{0, 1}};
    slices.edgeSource = {0};
    slices.faceBegin = {0, 0};
    slices.cornerBegin = {0};
    scene::Scene scene;
    scene.slices = &slices;
    scene.camera.eye = {0, 0, 10};
    scene.placements.resize(1);
    scene.ballRadius = 0.1;
    scene.barRadius = 0.05;
    const slicing::Object object = support::objectOf(support::named("5-cell"));
    EXPECT_EQ(disks(scene, object), 3U);
    scene.look.parts.balls = false;
    EXPECT_EQ(disks(scene, object), 1U) << "bars have round ends";
    scene.look.parts.bars = false;
    EXPECT_EQ(disks(scene, object), 0U);
}

}  // namespace
