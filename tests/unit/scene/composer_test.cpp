// Tests of the contents of scenes: the colors of cells, and the parts of the projection.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include <gtest/gtest.h>

#include "geometry/point_cloud.hpp"
#include "scene/composer.hpp"
#include "slicing/cloud_slicer.hpp"
#include "unit/scene/composed_scene.hpp"
#include "unit/slicing/support.hpp"

namespace {

using namespace oval4d;
using scene::composed;
using scene::Scene;
using support::named;

TEST(Highlight, ColorsTheCellThatIsHighlightedAndNoOther) {
    const auto& p = named("24-cell");
    slicing::SliceSet slices;
    slicing::CellComplexSlicer().slice(p, {}, {-1, 3, 0.5}, slices);
    for (const auto coloring : {scene::Coloring::cell, scene::Coloring::cell_type, scene::Coloring::plain,
                                scene::Coloring::w, scene::Coloring::light}) {
        scene::Composer composer;
        Scene s;
        const auto colors = [&](const std::optional<slicing::Element>& highlight) {
            scene::Look look;
            look.coloring = coloring;
            look.highlight = highlight;
            composer.compose(support::objectOf(p), {}, slices, 0, look, {}, s);
            return s.cellColors;
        };
        const auto without = colors({});
        for (const unsigned cell : {3U, 3U, 17U}) {
            auto expected = without;
            expected[cell] = scene::style().highlight;
            EXPECT_EQ(colors(slicing::Element{slicing::ElementKind::cell, cell}), expected);
        }
        EXPECT_EQ(colors(slicing::Element{slicing::ElementKind::edge, 0}), without);
        EXPECT_EQ(colors({}), without);
    }
}

TEST(ObjectProjection, hasTheSectionOfTheFocusOrOfAllHyperplanes) {
    scene::Look look;
    EXPECT_FALSE(composed("24-cell", 21, {}, look).projectionPlacement.shown);
    look.projection.kind = scene::ProjectionKind::orthogonal;
    const Scene focus = composed("24-cell", 21, {}, look);
    ASSERT_EQ(focus.projection.parts.size(), 2U);
    EXPECT_EQ(focus.projection.parts[1].barColor, scene::style().axes[3]);
    look.parts.allSections = true;
    const Scene all = composed("24-cell", 21, {}, look);
    ASSERT_EQ(all.projection.parts.size(), 22U);
    ASSERT_EQ(all.projection.elements.vertexBegin.size(), 23U);
    for (std::size_t i = 1; i < all.projection.parts.size(); ++i)
        EXPECT_EQ(all.projection.parts[i].barColor == scene::style().axes[3], i == 11);
    look.parts.bars = look.parts.balls = false;
    const Scene none = composed("24-cell", 21, {}, look);
    EXPECT_EQ(none.projection.parts[0].ballRadius, 0);
    EXPECT_EQ(none.projection.parts[0].barRadius, 0);
}

TEST(ObjectProjection, colorsTheSectionThatIsACellByItsNeighbors) {
    scene::Look look;
    look.projection.kind = scene::ProjectionKind::perspective;
    const Scene s = composed("8-cell", 3, {}, look, 1, 1);  // the hyperplane w = 1 contains a whole cell
    const slicing::SliceSet& elements = s.projection.elements;
    ASSERT_EQ(s.projection.faceCells.size(), elements.faceSource.size());
    ASSERT_EQ(elements.faceCount(1), 6U);
    for (std::uint32_t f = elements.faceBegin[1]; f < elements.faceBegin[2]; ++f) {
        ASSERT_GE(elements.faceSource[f], 8U) << "a 2-face, not a cell";
        const std::uint32_t cell = s.projection.faceCells[f];
        ASSERT_LT(cell, s.cellColors.size());
        const auto faces = named("8-cell").cells[cell];
        EXPECT_EQ(std::ranges::count(faces, elements.faceSource[f] - 8), 1) << "the cell has the 2-face";
    }
}

TEST(Opacity, isMultipliedInSlicesAndProjectionAndStaysBelowOne) {
    for (const scene::Background background : {scene::Background::dark, scene::Background::white}) {
        scene::Look look;
        look.background = background;
        look.projection.kind = scene::ProjectionKind::perspective;
        const Scene plain = composed("24-cell", 5, {}, look);
        EXPECT_EQ(plain.faceOpacity, scene::style(background).faceOpacity);
        for (const double opacity : {0.25, 0.5, 2.0, 4.0}) {
            SCOPED_TRACE(opacity);
            const auto expectMultiplied = [&](double before, double after) {
                EXPECT_LT(after, 1) << "1 means that faces may cross each other";
                EXPECT_NEAR(after, std::min(opacity * before, 1.0), 0.002);
            };
            look.opacity = opacity;
            const Scene changed = composed("24-cell", 5, {}, look);
            expectMultiplied(plain.faceOpacity, changed.faceOpacity);
            ASSERT_EQ(changed.projection.parts.size(), 2U);
            for (std::size_t i = 0; i < 2; ++i) {
                EXPECT_GT(plain.projection.parts[i].faceOpacity, 0);
                expectMultiplied(plain.projection.parts[i].faceOpacity, changed.projection.parts[i].faceOpacity);
            }
        }
    }
}

TEST(Opacity, ofFacesOfSlicesThatMayCrossIsOneInAnyCase) {
    scene::Look look;
    look.projection.kind = scene::ProjectionKind::perspective;
    for (const double opacity : {0.25, 1.0, 4.0}) {
        look.opacity = opacity;
        const Scene star = composed("small stellated 120-cell", 1, {}, look);
        EXPECT_TRUE(star.needsDepthBuffer);
        EXPECT_EQ(star.faceOpacity, 1);
        ASSERT_EQ(star.projection.parts.size(), 2U);
        EXPECT_NEAR(star.projection.parts[1].faceOpacity, std::min(0.5 * opacity, 1.0), 0.002)
            << "its section is as translucent as that of a convex polytope";
    }
}

TEST(Cloud, isShownWithoutBallsAndBars) {
    const auto cloud = std::make_shared<const geometry::PointCloud>(
        geometry::makePointCloud("dots", {{1, 0, 0, 0}, {0, 1, 0, 0.2}, {0, 0, -1, 0}}, {0, 0, 0.1}));
    slicing::SliceSet slices;
    slicing::CloudSlicer().slice(*cloud, {}, {-1, 3, 0.5}, slices);
    scene::Look look;
    look.projection.kind = scene::ProjectionKind::perspective;
    const auto compose = [&] {
        Scene s;
        scene::Composer().compose(cloud, {}, slices, 0, look, {}, s);
        return s;
    };
    const Scene whole = compose();
    EXPECT_EQ(whole.drawnBallRadius(), whole.ballRadius);
    look.parts.balls = false;
    for (const bool bars : {true, false}) {
        look.parts.bars = bars;
        const Scene s = compose();
        EXPECT_EQ(s.drawnBallRadius(), s.barRadius);
        EXPECT_EQ(s.drawnBallColor(), s.style().bar);
        ASSERT_EQ(s.projection.parts.size(), 2U);
        for (const scene::ProjectionPartLook& part : s.projection.parts) {
            EXPECT_GT(part.ballRadius, 0);
            EXPECT_LT(part.ballRadius, whole.projection.parts[0].ballRadius);
        }
    }
    look.parts.bars = false;
    EXPECT_EQ(composed("5-cell", 21, {}, look).drawnBallRadius(), 0) << "vertices of polytopes are hidden";
}

}  // namespace
