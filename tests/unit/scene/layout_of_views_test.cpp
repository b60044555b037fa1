// Tests of the layout of views: where the slices stand in each view.

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
using scene::kWindows;
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
                // The circumscribed sphere of the focus slice must be entirely visible.
                const double radius = s.scale * s.circumradius;
                EXPECT_GT(project(s, {0, radius, 0}).y, 0);
                EXPECT_LT(project(s, {0, -radius, 0}).y, viewport.height - strip);
            }
        }
    }
}

TEST(Oval, closes) {
    const Scene s = composed("5-cell");
    // Both arms of the oval rise steadily. They move apart first, and meet again at the top.
    double widest = 0;
    for (int i = 10; i < 20; ++i) {
        EXPECT_LT(project(s, s.placements[i + 1].position).y, project(s, s.placements[i].position).y);
        widest = std::max(widest, project(s, s.placements[i].position).x - 640);
    }
    EXPECT_LT(project(s, s.placements[20].position).x - 640, 0.8 * widest);
    EXPECT_NEAR(project(s, s.placements[13].position).x - 640, 640 - project(s, s.placements[7].position).x, 1e-6);
}

TEST(EvenNumbersOfSlices, standSymmetricallyAndApart) {
    for (const scene::ViewTableRow& view : scene::kViews) {
        if (!view.showsAllSlices) continue;
        scene::Look look;
        look.view = view.value;
        for (const std::size_t count : {2, 4, 10}) {
            SCOPED_TRACE(testing::Message() << view.name << ", " << count);
            const Scene s = composed("24-cell", static_cast<int>(count), {}, look);
            ASSERT_EQ(s.placements.size(), count);
            for (std::size_t i = 0; i < count; ++i) {
                const glm::dvec3 here = s.placements[i].position, there = s.placements[count - 1 - i].position;
                // The last row of a grid may be shorter than the others, so it is not symmetric.
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
    // The camera looks in the direction of −z, as in Kageyama's paper.
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
                std::vector<int> rows{0};  // per row: the number of slices
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

}  // namespace
