// The layout of pictures: the slices, the projection, the camera, the matrix and the axes.

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

TEST(Oval, standsOnAParabolaWithTheFocusInTheMiddle) {
    const Scene s = composed("24-cell");
    const auto& focus = s.placements[10];
    EXPECT_TRUE(focus.focus);
    EXPECT_EQ(focus.position, glm::dvec3(0));
    const double a = s.placements[11].position.x;
    const double b = -s.placements[11].position.z;
    EXPECT_GT(a, 0);
    EXPECT_GT(b, 0);
    for (int i = 0; i < 21; ++i) {
        const int n = i - 10;
        EXPECT_EQ(s.placements[i].index, n);
        EXPECT_NEAR(s.placements[i].position.x, a * n, 1e-9);
        EXPECT_NEAR(s.placements[i].position.z, -b * n * n, 1e-9);
        EXPECT_NEAR(s.placements[i].w, n * named("24-cell").circumradius / 10, 1e-12);
    }
}

TEST(Oval, keepsEverySliceInSightAndClearOfTheCoordinates) {
    for (const scene::Viewport viewport :
         {scene::Viewport{1280, 720}, {1920, 1080}, {640, 640}, {375, 667}, {3000, 800}}) {
        for (const char* name : {"5-cell", "120-cell"}) {
            for (const int count : {1, 5, 21, 61}) {
                const Scene s = composed(name, count, viewport);
                const double strip = (s.coordinates.zero + s.coordinates.amplitude) * viewport.height;
                for (const auto& placement : s.placements) {
                    const glm::dvec2 at = project(s, placement.position);
                    EXPECT_GT(at.x, 0);
                    EXPECT_LT(at.x, viewport.width);
                    EXPECT_GT(at.y, 0);
                    EXPECT_LT(at.y, viewport.height - strip);
                    EXPECT_LT(project(s, placement.labelAt).y, viewport.height - strip);
                }
                // The circumscribed sphere of the focus slice is entirely visible.
                const double radius = s.scale * s.circumradius;
                EXPECT_GT(project(s, {0, radius, 0}).y, 0);
                EXPECT_LT(project(s, {0, -radius, 0}).y, viewport.height - strip);
            }
        }
    }
}

TEST(Oval, closes) {
    const Scene s = composed("5-cell");
    // Both arms of the oval rise monotonically, move apart and meet again at the top.
    double widest = 0;
    for (int i = 10; i < 20; ++i) {
        EXPECT_LT(project(s, s.placements[i + 1].position).y, project(s, s.placements[i].position).y);
        widest = std::max(widest, project(s, s.placements[i].position).x - 640);
    }
    EXPECT_LT(project(s, s.placements[20].position).x - 640, 0.8 * widest);
    EXPECT_NEAR(project(s, s.placements[13].position).x - 640, 640 - project(s, s.placements[7].position).x, 1e-6);
}

TEST(EvenNumbersOfSlices, standSymmetricallyAndApart) {
    for (const scene::ViewRow& view : scene::kViews) {
        if (!view.showsAllSlices) continue;
        scene::Look look;
        look.view = view.value;
        for (const std::size_t count : {2, 4, 10}) {
            SCOPED_TRACE(testing::Message() << view.name << ", " << count);
            const Scene s = composed("24-cell", static_cast<int>(count), {}, look);
            ASSERT_EQ(s.placements.size(), count);
            for (std::size_t i = 0; i < count; ++i) {
                const glm::dvec3 here = s.placements[i].position, there = s.placements[count - 1 - i].position;
                // The last row of a grid may be shorter than the others.
                if (look.view != scene::View::grid) {
                    EXPECT_EQ(here, glm::dvec3(-there.x, -there.y, there.z)) << i;
                }
                if (i == 0) continue;
                EXPECT_GT(glm::distance(here, s.placements[i - 1].position), 2 * (s.sliceRadius + s.ballRadius)) << i;
            }
        }
    }
}

TEST(Oval, followsTheFocus) {
    const Scene s = composed("5-cell", 21, {}, {}, 4);
    EXPECT_EQ(s.placements[10].index, 4);
    EXPECT_TRUE(s.placements[10].focus);
    EXPECT_EQ(s.placements[10].position, glm::dvec3(0));
    EXPECT_EQ(s.placements[6].label, "0");
    EXPECT_EQ(s.placements[10].label, "w = 0.51, tetrahedron");
}

TEST(Single, drawsTheFocusAloneAndLarge) {
    scene::Look look;
    look.view = scene::View::single;
    const Scene s = composed("8-cell", 21, {}, look);
    int drawn = 0;
    for (const auto& placement : s.placements) drawn += placement.drawn ? 1 : 0;
    EXPECT_EQ(drawn, 1);
    EXPECT_TRUE(s.placements[10].drawn);
    const double radius = s.scale * s.circumradius;
    EXPECT_GT(project(s, {0, -radius, 0}).y - project(s, {0, radius, 0}).y, 0.7 * 720);
    // The camera looks in the direction of −z, as in the paper.
    EXPECT_NEAR(s.camera.eye.x, 0, 1e-12);
    EXPECT_NEAR(s.camera.eye.y, 0, 1e-12);
    EXPECT_GT(s.camera.eye.z, 0);
}

TEST(Strip, showsAllSlicesAtTheSameSizeInARow) {
    for (const scene::Viewport viewport : {scene::Viewport{1280, 720}, {3000, 800}, {640, 640}, {375, 667}}) {
        for (const int count : {1, 3, 21, 201}) {
            for (const bool whole : {false, true}) {
                scene::Look look;
                look.view = scene::View::strip;
                if (whole) look.projection.kind = scene::ProjectionKind::orthogonal;
                const Scene s = composed("24-cell", count, viewport, look);
                SCOPED_TRACE(testing::Message()
                             << viewport.width << " x " << viewport.height << ", " << count << whole);
                const double radius = radiusOnScreen(s, s.placements[0].position, s.sliceRadius);
                const double coordinates = s.coordinates.zero + s.coordinates.amplitude;
                glm::dvec2 before(-radius);
                for (const auto& slice : s.placements) {
                    EXPECT_TRUE(slice.drawn);
                    EXPECT_NEAR(radiusOnScreen(s, slice.position, s.sliceRadius), radius, 1e-9);
                    const glm::dvec2 at = project(s, slice.position);
                    EXPECT_GT(at.x - radius, before.x + radius) << "beside the slice before, which has a lower w";
                    EXPECT_NEAR(at.y, project(s, s.placements[0].position).y, 1e-6);
                    before = at;
                }
                EXPECT_LT(before.x + radius, viewport.width);
                EXPECT_LT(before.y + radius, (1 - coordinates) * viewport.height);
            }
        }
    }
}

TEST(Column, showsAllSlicesAtTheSameSizeWithTheLargestWAtTheTop) {
    for (const scene::Viewport viewport : {scene::Viewport{375, 667}, {200, 800}, {640, 640}, {1280, 720}}) {
        for (const int count : {1, 3, 21, 201}) {
            for (const bool whole : {false, true}) {
                scene::Look look;
                look.view = scene::View::column;
                if (whole) look.projection.kind = scene::ProjectionKind::orthogonal;
                const Scene s = composed("24-cell", count, viewport, look);
                SCOPED_TRACE(testing::Message()
                             << viewport.width << " x " << viewport.height << ", " << count << whole);
                const double radius = radiusOnScreen(s, s.placements[0].position, s.sliceRadius);
                const double coordinates = s.coordinates.zero + s.coordinates.amplitude;
                const glm::dvec2 lowest = project(s, s.placements[0].position);
                glm::dvec2 before(lowest.x, lowest.y + 3 * radius);
                for (const auto& slice : s.placements) {
                    EXPECT_TRUE(slice.drawn);
                    EXPECT_NEAR(radiusOnScreen(s, slice.position, s.sliceRadius), radius, 1e-9);
                    const glm::dvec2 at = project(s, slice.position);
                    EXPECT_LT(at.y + radius, before.y - radius) << "above the slice before, which has a lower w";
                    EXPECT_NEAR(at.x, lowest.x, 1e-6);
                    before = at;
                }
                EXPECT_GT(before.y - radius, 0);
                EXPECT_LT(lowest.y + radius, (1 - coordinates) * viewport.height);
                EXPECT_GT(lowest.x - radius, 0);
                if (!whole || count == 1) continue;
                const scene::ProjectionPlacement& projection = s.projectionPlacement;
                EXPECT_TRUE(projection.shown);
                EXPECT_LT(project(s, projection.position).x + radiusOnScreen(s, projection.position, projection.radius),
                          lowest.x - radius);
            }
        }
    }
}

TEST(Column, hasLargerSlicesThanARowInATallPicture) {
    for (const scene::Viewport viewport : {scene::Viewport{375, 667}, {200, 800}, {320, 568}}) {
        for (const int count : {11, 21, 201}) {
            const auto radiusIn = [&](scene::View view) {
                scene::Look look;
                look.view = view;
                const Scene s = composed("24-cell", count, viewport, look);
                return radiusOnScreen(s, {0, 0, 0}, s.sliceRadius);
            };
            EXPECT_GT(radiusIn(scene::View::column), radiusIn(scene::View::strip))
                << viewport.width << " x " << viewport.height << ", " << count;
        }
    }
}

TEST(Grid, showsAllSlicesAtTheSameSizeInRowsBesideTheAxes) {
    for (const scene::Viewport viewport : kWindows) {
        for (const int count : {3, 21, 61, 201}) {
            for (const bool whole : {false, true}) {
                scene::Look look;
                look.view = scene::View::grid;
                if (whole) look.projection.kind = scene::ProjectionKind::orthogonal;
                const Scene s = composed("24-cell", count, viewport, look);
                SCOPED_TRACE(testing::Message()
                             << viewport.width << " x " << viewport.height << ", " << count << whole);
                const double reach = s.sliceRadius + s.ballRadius, height = viewport.height;
                const double radius = radiusOnScreen(s, s.placements[0].position, reach);
                const double bottom = (1 - s.coordinates.zero - s.coordinates.amplitude) * height;
                const glm::dvec2 axes(s.axes.x * height, s.axes.y * height);
                const glm::dvec2 first = project(s, s.placements[0].position);
                std::vector<int> rows{0};  // the number of slices in each row
                glm::dvec2 before = first;
                for (const auto& slice : s.placements) {
                    const glm::dvec2 at = project(s, slice.position);
                    EXPECT_TRUE(slice.drawn);
                    EXPECT_NEAR(radiusOnScreen(s, slice.position, reach), radius, 1e-9);
                    EXPECT_TRUE(at.x > radius && at.x < viewport.width - radius) << at.x;
                    EXPECT_TRUE(at.y > radius && at.y < bottom - radius) << at.y;
                    EXPECT_GT(glm::distance(at, axes), radius + s.axes.length * height);
                    if (at.y > before.y + radius) {
                        EXPECT_GT(at.y - radius, before.y + radius) << "below the row before";
                        EXPECT_NEAR(at.x, first.x, 1e-6);
                        rows.push_back(0);
                    } else if (rows.back() > 0) {
                        EXPECT_GT(at.x - radius, before.x + radius) << "beside the slice before, which has a lower w";
                        EXPECT_NEAR(at.y, before.y, 1e-6);
                    }
                    ++rows.back();
                    before = at;
                }
                for (const int length : rows) EXPECT_LE(length, rows[0]);
                for (std::size_t i = 0; i + 1 < rows.size(); ++i) EXPECT_EQ(rows[i], rows[0]) << i;
                if (count == 21 && viewport == scene::Viewport{} && !whole) {
                    EXPECT_EQ(rows, (std::vector<int>{7, 7, 7}));
                }
            }
        }
    }
}

TEST(Grid, hasLargerSlicesThanARowAndAColumn) {
    for (const scene::Viewport viewport : kWindows) {
        for (const int count : {11, 21, 201}) {
            const auto radiusIn = [&](scene::View view) {
                scene::Look look;
                look.view = view;
                const Scene s = composed("24-cell", count, viewport, look);
                return radiusOnScreen(s, {0, 0, 0}, s.sliceRadius);
            };
            EXPECT_GT(radiusIn(scene::View::grid),
                      std::max(radiusIn(scene::View::strip), radiusIn(scene::View::column)))
                << viewport.width << " x " << viewport.height << ", " << count;
        }
    }
}

// A negative field of view would show the picture upside down.
TEST(Layout, ofVeryNarrowPicturesIsUpright) {
    for (const scene::Viewport viewport : {scene::Viewport{16, 400}, {16, 1000}, {16, 8192}, {8192, 16}, {16, 16}}) {
        for (const scene::ViewRow& view : scene::kViews) {
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
                for (const scene::ViewRow& view : scene::kViews) {
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
                    // Everything is inside the sphere, with the balls.
                    for (const glm::dvec3& vertex : s.projection.elements.vertices)
                        EXPECT_LE(glm::length(vertex) * s.projection.scale + s.projection.parts[0].ballRadius,
                                  sphere * (1 + 1e-9));
                }
            }
        }
    }
}

TEST(Layout, hasTheRadiiOfBallsAndBars) {
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
    for (const scene::ViewRow& view : scene::kViews) {
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
                const scene::MatrixLayout& m = s.matrix;
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
        for (const scene::ViewRow& view : scene::kViews) {
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
