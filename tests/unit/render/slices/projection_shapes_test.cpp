// Tests of the shapes of the projection of the whole object.

#include <algorithm>
#include <cstddef>
#include <cstdint>

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
    look.parts.faces = false;
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
    look.parts.faces = false;  // if faces were shown, the section of this star would be filled
    look.projection.kind = scene::ProjectionKind::orthogonal;
    const Subject subject("icosahedral 120-cell", randomRotation(42), 1, look, {320, 240});
    ProjectionShapeCollector::Layers layers;
    ProjectionShapeCollector().collect(subject.scene, layers);
    EXPECT_EQ(countFacesOf(layers.translucent), subject.polytope->faces.size());
}

TEST(ProjectionShapes, HaveThePiecesOfTheFocusSectionOfAStar) {
    scene::Look look;
    look.projection.kind = scene::ProjectionKind::perspective;
    const Subject subject("small stellated 120-cell", randomRotation(43), 3, look, {320, 240});
    const slicing::FilledFaces& fill = subject.scene.fill;
    const std::uint32_t pieces = fill.pieceBegin[fill.faceBegin[2]] - fill.pieceBegin[fill.faceBegin[1]];
    ASSERT_GT(pieces, 0U);
    ProjectionShapeCollector::Layers layers;
    ProjectionShapeCollector().collect(subject.scene, layers);
    EXPECT_EQ(countFacesOf(layers.solid), 0U);
    EXPECT_EQ(countFacesOf(layers.translucent), pieces);
}

TEST(ProjectionShapes, HaveNoBallsWhereBarsAreCutOff) {
    scene::Look look;
    look.projection.kind = scene::ProjectionKind::orthogonal;
    look.parts.back = look.parts.bars = false;
    const Subject subject("small stellated 120-cell", randomRotation(44), 1, look, {1280, 720});
    const slicing::SliceSet& elements = subject.scene.projection.elements;
    std::size_t balls = 0;
    for (std::size_t v = 0; v < elements.vertexCount(0); ++v) balls += elements.hasBall(v) ? 1 : 0;
    ASSERT_GT(balls, 0U);
    ASSERT_LT(balls, elements.vertexCount(0));
    ProjectionShapeCollector::Layers layers;
    ProjectionShapeCollector().collect(subject.scene, layers);
    const auto disks = std::ranges::count(layers.solid.patches(), Patch::Form::disk, &Patch::form);
    EXPECT_EQ(static_cast<std::size_t>(disks), balls);
}

}  // namespace
}  // namespace oval4d::render
