// The shapes of the projection of the whole object.

#include <algorithm>
#include <cstddef>

#include <gtest/gtest.h>

#include "render/slices/projection_shapes.hpp"
#include "unit/render/pictures.hpp"

namespace oval4d::render {
namespace {

std::size_t countFacesOf(const ShapeBatch& shapes) {
    return static_cast<std::size_t>(std::ranges::count(shapes.patches(), Patch::Form::face, &Patch::form));
}

TEST(ProjectionShapes, AreTheConvexPiecesOfFacesThatAreNotConvex) {
    scene::Look look;
    look.parts.projectionFaces = true;
    look.projection.kind = scene::ProjectionKind::orthogonal;
    const Subject subject("small stellated 120-cell", randomRotation(41), 1, look, {320, 240});
    ProjectionShapeCollector::Layers layers;
    ProjectionShapeCollector().collect(subject.scene, layers);
    const slicing::FilledFaces& fill = subject.scene.projection.fill;
    ASSERT_EQ(fill.faces.size(), subject.polytope->faces.size());
    EXPECT_EQ(countFacesOf(layers.solid), 0U);
    EXPECT_EQ(countFacesOf(layers.translucent), fill.cornerBegin.size() - 1);
}

TEST(ProjectionShapes, AreTheFacesThemselvesIfTheyAreConvex) {
    scene::Look look;
    look.parts.projectionFaces = true;
    look.projection.kind = scene::ProjectionKind::orthogonal;
    // The section of this star is not filled.
    const Subject subject("icosahedral 120-cell", randomRotation(42), 1, look, {320, 240});
    ProjectionShapeCollector::Layers layers;
    ProjectionShapeCollector().collect(subject.scene, layers);
    EXPECT_EQ(countFacesOf(layers.translucent), subject.polytope->faces.size());
}

}  // namespace
}  // namespace oval4d::render
