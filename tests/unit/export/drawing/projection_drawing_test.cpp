// Tests of drawings of the projection of the whole object.

#include <cstddef>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "export/drawing/projection_drawing.hpp"
#include "scene/composer.hpp"
#include "slicing/overloaded.hpp"
#include "slicing/visibility.hpp"
#include "unit/slicing/support.hpp"

namespace {

using namespace oval4d;

// Returns the opacities of all shapes in the drawing of a rectified 5-cell, in drawing order.
std::vector<double> opacities(const scene::CellTypeFilter& filter) {
    const polytopes::Polytope polytope = support::rectifiedFiveCell();
    slicing::SliceSet slices;
    slicing::CellComplexSlicer().slice(polytope, {}, {0, 1, 1}, slices);
    scene::Look look;
    look.projection.kind = scene::ProjectionKind::orthogonal;
    look.parts.projectionFaces = true;
    look.cellTypes = filter;
    scene::Scene scene;
    scene::Composer().compose(support::objectOf(polytope), {}, slices, 0, look, {}, scene);
    std::vector<double> found;
    for (const exports::ShapeGroup& group : exports::drawProjection(scene).groups) {
        for (const exports::DrawnShape& shape : group.shapes) {
            std::visit(slicing::Overloaded{[&](const exports::LineSegment& line) { found.push_back(line.opacity); },
                                           [&](const exports::FilledPolygon& face) { found.push_back(face.opacity); },
                                           [&](const exports::Disk& ball) { found.push_back(ball.opacity); },
                                           [](const auto& /*other*/) {}},
                       shape);
        }
    }
    return found;
}

TEST(ProjectionDrawing, fadesWhatThePictureFades) {
    const std::vector<double> full = opacities({}), faded = opacities({{}, {0, 1}});
    // The shapes are at least 10 vertices, 30 edges (each with a white line behind it) and 30 triangles. The focus
    // slice has shapes, too.
    ASSERT_GE(full.size(), 10U + 2 * 30 + 30);
    ASSERT_EQ(faded.size(), full.size());
    for (std::size_t i = 0; i < full.size(); ++i)
        EXPECT_DOUBLE_EQ(faded[i], slicing::opacityOf(slicing::Visibility::faded) * full[i]) << i;
    EXPECT_TRUE(opacities({{0, 1}, {}}).empty());
}

}  // namespace
