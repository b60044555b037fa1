// Tests of the layout of pictures: the slices, the projection, the camera, the matrix and the axes.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "unit/scene/composed_scene.hpp"
#include "unit/slicing/support.hpp"

namespace {

using namespace oval4d;
using scene::composed;
using scene::expectLabelsApart;
using scene::kWindows;
using scene::LabelBox;
using scene::project;
using scene::radiusOnScreen;
using scene::Scene;
using support::named;

// Very narrow pictures are upright: a negative field of view would show the picture upside down.
TEST(PictureLayout, ofVeryNarrowPicturesIsUpright) {
    for (const scene::Viewport viewport : {scene::Viewport{16, 400}, {16, 1000}, {16, 8192}, {8192, 16}, {16, 16}}) {
        for (const scene::ViewTableRow& view : scene::kViews) {
            scene::Look look;
            look.view = view.value;
            const Scene s = composed("24-cell", 21, viewport, look);
            EXPECT_GT(s.camera.fieldOfView, 0) << viewport.width << " x " << viewport.height << ", " << view.name;
            EXPECT_LT(s.camera.fieldOfView, std::numbers::pi) << viewport.width << " x " << viewport.height;
            EXPECT_GT(radiusOnScreen(s, {0, 0, 0}, s.sliceRadius), 0) << viewport.width << " x " << viewport.height;
        }
    }
}

TEST(ObjectProjection, standsInSightAndClearOfTheSlices) {
    for (const scene::Viewport viewport :
         {scene::Viewport{1280, 720}, {1920, 1080}, {640, 640}, {375, 667}, {3000, 800}}) {
        for (const char* name : {"5-cell", "120-cell"}) {
            for (const int count : {1, 3, 5, 21, 61, 201}) {
                for (const scene::ViewTableRow& view : scene::kViews) {
                    SCOPED_TRACE(view.name);
                    scene::Look look;
                    look.view = view.value;
                    look.projection.kind = scene::ProjectionKind::perspective;
                    const Scene s = composed(name, count, viewport, look);
                    ASSERT_TRUE(s.projectionPlacement.shown);
                    const glm::dvec3 position = s.projectionPlacement.position;
                    const double sphere = s.projectionPlacement.radius;
                    const glm::dvec2 at = project(s, position);
                    const double radius = radiusOnScreen(s, position, sphere);
                    EXPECT_GT(radius, 0.06 * std::min(viewport.width, viewport.height)) << count;
                    EXPECT_GT(at.x - radius, 0);
                    EXPECT_LT(at.x + radius, viewport.width);
                    EXPECT_GT(at.y - radius, 0);
                    for (std::size_t i = 0; i < s.placements.size(); ++i) {
                        const auto& slice = s.placements[i];
                        if (!slice.drawn) continue;
                        const double u = count == 1 ? 0 : 2.0 * static_cast<double>(i) / (count - 1) - 1;
                        const double own =
                            radiusOnScreen(s, slice.position, s.sliceRadius * std::sqrt(std::max(0.0, 1 - u * u)));
                        EXPECT_GT(glm::distance(at, project(s, slice.position)), radius + own) << count << ' ' << i;
                    }
                    // The whole projection, with its balls, is inside the sphere.
                    for (const glm::dvec3& vertex : s.projection.elements.vertices)
                        EXPECT_LE(glm::length(vertex) * s.projection.scale + s.projection.parts[0].ballRadius,
                                  sphere * (1 + 1e-9));
                }
            }
        }
    }
}

TEST(PictureLayout, hasTheRadiiOfBallsAndBars) {
    scene::Look look;
    look.projection.kind = scene::ProjectionKind::orthogonal;
    for (const char* name : {"5-cell", "120-cell"}) {
        const Scene plain = composed(name, 21, {}, look);
        for (const double thickness : {0.25, 1.0, 4.0}) {
            SCOPED_TRACE(testing::Message() << name << ", thickness " << thickness);
            scene::Look changed = look;
            changed.thickness = thickness;
            const Scene s = composed(name, 21, {}, changed);
            const double relative = thickness * slicing::relativeBallRadius(support::objectOf(support::named(name)));
            EXPECT_DOUBLE_EQ(s.ballRadius, relative * s.sliceRadius);
            EXPECT_DOUBLE_EQ(s.barRadius / s.ballRadius, plain.barRadius / plain.ballRadius);
            const scene::ProjectionPlacement& placement = s.projectionPlacement;
            EXPECT_DOUBLE_EQ(placement.objectRadius, s.projection.scale * s.circumradius);
            EXPECT_DOUBLE_EQ(placement.objectRadius + placement.ballRadius, placement.radius);
            EXPECT_LT(placement.ballRadius / placement.objectRadius, relative) << "there is less room than in a slice";
            EXPECT_DOUBLE_EQ(placement.ballRadius / placement.objectRadius,
                             thickness * plain.projectionPlacement.ballRadius / plain.projectionPlacement.objectRadius);
            EXPECT_DOUBLE_EQ(placement.barRadius / placement.ballRadius, s.barRadius / s.ballRadius);
        }
    }
}

TEST(Thickness, keepsSlicesAndProjectionWithTheirBallsInSight) {
    for (const scene::ViewTableRow& view : scene::kViews) {
        for (const double thickness : {0.25, 4.0}) {
            SCOPED_TRACE(testing::Message() << view.name << ", thickness " << thickness);
            scene::Look look;
            look.view = view.value;
            look.projection.kind = scene::ProjectionKind::perspective;
            look.thickness = thickness;
            const Scene s = composed("5-cell", 21, {}, look);
            const double reach = s.sliceRadius + s.ballRadius;
            EXPECT_GT(project(s, {0, reach, 0}).y, 0);
            EXPECT_LT(project(s, {0, -reach, 0}).y, s.viewport.height);

            const scene::ProjectionPlacement& placement = s.projectionPlacement;
            const glm::dvec2 at = project(s, placement.position);
            const double radius = radiusOnScreen(s, placement.position, placement.radius);
            EXPECT_GT(radius, 0);
            EXPECT_GT(at.x - radius, 0);
            EXPECT_LT(at.x + radius, s.viewport.width);
            EXPECT_GT(at.y - radius, 0);
            for (const glm::dvec3& vertex : s.projection.elements.vertices)
                EXPECT_LE(glm::length(vertex) * s.projection.scale + s.projection.parts[0].ballRadius,
                          placement.radius * (1 + 1e-9));
            for (int i = 0; i < 21; ++i) {
                const scene::SlicePlacement& slice = s.placements[i];
                if (!slice.drawn) continue;
                const double u = (i - 10) / 10.0, own = reach * std::sqrt(1 - u * u);
                EXPECT_GT(glm::distance(at, project(s, slice.position)),
                          radius + radiusOnScreen(s, slice.position, own))
                    << i;
            }
        }
    }
}

TEST(Thickness, changesNothingInTheMatrix) {
    scene::Look look;
    look.view = scene::View::matrix;
    const Scene plain = composed("24-cell", 21, {}, look);
    look.thickness = 4;
    EXPECT_TRUE(composed("24-cell", 21, {}, look).matrix == plain.matrix);
}

TEST(Thickness, ofAnEarlierPictureIsForgotten) {
    const auto& p = named("24-cell");
    slicing::SliceSet slices;
    slicing::CellComplexSlicer().slice(p, {}, {-1, 3, 0.5}, slices);
    scene::Composer composer;
    Scene reused;
    for (const double thickness : {1.0, 3.0, 0.5}) {
        scene::Look look;
        look.thickness = thickness;
        Scene fresh;
        composer.compose(support::objectOf(p), {}, slices, 0, look, {}, reused);
        scene::Composer().compose(support::objectOf(p), {}, slices, 0, look, {}, fresh);
        EXPECT_EQ(reused.ballRadius, fresh.ballRadius);
        EXPECT_EQ(reused.barRadius, fresh.barRadius);
        EXPECT_EQ(reused.camera.fieldOfView, fresh.camera.fieldOfView);
    }
}

TEST(CameraOrbit, turnsTheCameraAboutTheFocus) {
    scene::Look look;
    look.orbit = {0.7, 0.2, 1.5};
    const Scene turned = composed("5-cell", 21, {}, look);
    const Scene straight = composed("5-cell");
    EXPECT_NEAR(glm::length(turned.camera.eye), glm::length(straight.camera.eye), 1e-12);
    EXPECT_LT(glm::distance(project(turned, {}), project(straight, {})), 1e-6);
    EXPECT_GT(std::tan(straight.camera.fieldOfView / 2) / std::tan(turned.camera.fieldOfView / 2), 1.49);
    look.orbit.elevation = 10;
    EXPECT_TRUE(std::isfinite(composed("5-cell", 21, {}, look).camera.view()[0][0]));
}

TEST(Matrix, standsBesideTheFocusSlice) {
    for (const scene::Viewport viewport : kWindows) {
        for (const bool whole : {false, true}) {
            for (const bool coordinates : {false, true}) {
                scene::Look look;
                look.view = scene::View::matrix;
                look.parts.coordinates = coordinates;
                if (whole) look.projection.kind = scene::ProjectionKind::orthogonal;
                const Scene s = composed("24-cell", 21, viewport, look);
                SCOPED_TRACE(testing::Message() << viewport.width << " x " << viewport.height << ", " << whole);
                const scene::SectionMatrixLayout& m = s.matrix;
                ASSERT_TRUE(m.shown);
                EXPECT_GT(m.panel * viewport.height, 0.09 * std::min(viewport.width, viewport.height));
                const double height = viewport.height, left = m.left * height, right = left + 4 * m.step * height;
                const double bottom = (1 - m.bottom) * height, top = bottom - 4 * m.step * height;
                EXPECT_GE(left, 0);
                EXPECT_LE(right - (m.step - m.panel) * height, viewport.width + 1e-9);
                EXPECT_GE(top + (m.step - m.panel) * height, -1e-9);
                EXPECT_LE(bottom, height - (coordinates ? s.coordinates.zero + s.coordinates.amplitude : 0) * height);
                const auto isOutside = [&](const glm::dvec2& at, double radius) {
                    return at.x + radius <= left || at.x - radius >= right || at.y + radius <= top ||
                           at.y - radius >= bottom;
                };
                const double radius = s.scale * s.circumradius;
                EXPECT_TRUE(isOutside(project(s, {0, 0, 0}), radiusOnScreen(s, {0, 0, 0}, radius)));
                if (whole) {
                    const scene::ProjectionPlacement& placement = s.projectionPlacement;
                    EXPECT_TRUE(placement.shown && isOutside(project(s, placement.position),
                                                             radiusOnScreen(s, placement.position, placement.radius)));
                }
                for (const LabelBox& box : expectLabelsApart(s)) {
                    EXPECT_TRUE(box.isInside(viewport));
                    EXPECT_TRUE(box.right <= left || box.left >= right || box.bottom <= top || box.top >= bottom);
                }
            }
        }
    }
}

TEST(Axes, areBesideTheSliceAndTheProjection) {
    for (const scene::Viewport viewport :
         {scene::Viewport{768, 1024}, {900, 600}, {640, 640}, {1280, 720}, {375, 667}}) {
        for (const scene::ViewTableRow& view : scene::kViews) {
            if (view.showsAllSlices) continue;
            for (const bool whole : {false, true}) {
                scene::Look look;
                look.view = view.value;
                if (whole) look.projection.kind = scene::ProjectionKind::orthogonal;
                const Scene s = composed("24-cell", 21, viewport, look);
                SCOPED_TRACE(testing::Message() << viewport.width << " x " << viewport.height << ", " << whole);
                const double height = viewport.height;
                const glm::dvec2 center(s.axes.x * height, s.axes.y * height);
                const auto isBeside = [&](const glm::dvec3& position, double radius) {
                    return glm::distance(project(s, position), center) >
                           radiusOnScreen(s, position, radius) + s.axes.length * height;
                };
                EXPECT_TRUE(isBeside({0, 0, 0}, s.sliceRadius));
                EXPECT_TRUE(!whole || isBeside(s.projectionPlacement.position, s.projectionPlacement.radius));
            }
        }
    }
}

TEST(Axes, areBesideTheColumnAndTheProjection) {
    for (const scene::Viewport viewport : {scene::Viewport{375, 667}, {200, 800}, {768, 1024}, {320, 568}}) {
        for (const int count : {1, 3, 5, 21, 201}) {
            for (const bool whole : {false, true}) {
                scene::Look look;
                look.view = scene::View::column;
                if (whole) look.projection.kind = scene::ProjectionKind::orthogonal;
                const Scene s = composed("24-cell", count, viewport, look);
                SCOPED_TRACE(testing::Message()
                             << viewport.width << " x " << viewport.height << ", " << count << whole);
                const double height = viewport.height;
                const glm::dvec2 center(s.axes.x * height, s.axes.y * height);
                const auto isBeside = [&](const glm::dvec3& position, double radius) {
                    return glm::distance(project(s, position), center) >
                           radiusOnScreen(s, position, radius) + s.axes.length * height;
                };
                for (const auto& slice : s.placements) EXPECT_TRUE(isBeside(slice.position, s.sliceRadius));
                EXPECT_TRUE(!whole || isBeside(s.projectionPlacement.position, s.projectionPlacement.radius));
            }
        }
    }
}

}  // namespace
