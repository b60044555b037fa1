#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "unit/scene/composed_scene.hpp"

namespace {

using namespace oval4d;
using scene::composed;
using scene::expectLabelsApart;
using scene::kWindows;
using scene::LabelBox;
using scene::project;
using scene::radiusOnScreen;
using scene::Scene;

TEST(Labels, areEmptyWhenSwitchedOff) {
    scene::Look look;
    for (const auto& placement : composed("8-cell", 21, {}, look).placements) EXPECT_FALSE(placement.label.empty());
    look.parts.labels = false;
    for (const auto& placement : composed("8-cell", 21, {}, look).placements) EXPECT_TRUE(placement.label.empty());
}

TEST(Labels, areInThePictureAndApart) {
    for (const scene::Viewport viewport : kWindows) {
        for (const int count : {1, 3, 5, 11, 21, 41, 61, 101, 151, 201}) {
            for (const double spacing : {0.0, 1.0 / 4096, 1e-8, 1e3}) {
                for (const scene::ViewTableRow& view : scene::kViews) {
                    for (const bool whole : {false, true}) {
                        scene::Look look;
                        look.view = view.value;
                        look.parts.coordinates = !whole;
                        if (whole) look.projection.kind = scene::ProjectionKind::perspective;
                        const Scene s = composed("24-cell", count, viewport, look, whole ? 5 : 0, spacing);
                        SCOPED_TRACE(testing::Message() << viewport.width << " x " << viewport.height << ", " << count
                                                        << " slices, " << spacing << ", " << view.name << whole);
                        const double strip = whole ? 0 : s.coordinates.zero + s.coordinates.amplitude;
                        for (const LabelBox& box : expectLabelsApart(s)) {
                            EXPECT_TRUE(box.isInside(viewport));
                            EXPECT_LE(box.bottom, (1 - strip) * viewport.height);
                        }
                    }
                }
            }
        }
    }
}

// Expects that no label, except that of the focus slice, overlaps another slice. Ignores the balls of the slices.
void expectLabelsBesideSlices(const Scene& s) {
    for (const auto& placement : s.placements) {
        if (!placement.drawn || placement.focus || placement.label.empty()) continue;
        LabelBox text(s, placement);
        const double margin = 0.4 * (text.bottom - text.top);  // the margin of the plate behind the text, and more
        text.left += margin, text.right -= margin, text.top += 0.5 * margin, text.bottom -= 0.5 * margin;
        for (const auto& other : s.placements) {
            const double squared = s.circumradius * s.circumradius - other.w * other.w;
            if (!other.drawn || other.index == placement.index || squared <= 0) continue;
            const glm::dvec3 seen(s.camera.view() * glm::dvec4(other.position, 1));
            if (seen.z > -s.camera.near) continue;
            const double radius = radiusOnScreen(s, other.position, s.scale * std::sqrt(squared));
            EXPECT_FALSE(text.overlapsDisk(project(s, other.position), radius)) << placement.label << ", " << other.w;
        }
    }
}

TEST(Labels, standBesideTheSlices) {
    for (const scene::Viewport viewport : kWindows) {
        for (const int count : {3, 11, 21, 31, 61, 101}) {
            SCOPED_TRACE(testing::Message() << viewport.width << " x " << viewport.height << ", " << count);
            expectLabelsBesideSlices(composed("24-cell", count, viewport));
        }
    }
}

TEST(Labels, standToTheRightOfAColumn) {
    scene::Look look;
    look.view = scene::View::column;
    for (const scene::Viewport viewport : {scene::Viewport{375, 667}, {200, 800}, {1280, 720}}) {
        for (const int count : {3, 21, 61}) {
            const Scene s = composed("24-cell", count, viewport, look);
            SCOPED_TRACE(testing::Message() << viewport.width << " x " << viewport.height << ", " << count);
            int labeled = 0;
            for (const auto& placement : s.placements) {
                if (placement.label.empty()) continue;
                ++labeled;
                const LabelBox box(s, placement);
                const glm::dvec2 at = project(s, placement.position);
                EXPECT_GT(box.left, at.x + radiusOnScreen(s, placement.position, s.sliceRadius)) << placement.label;
                EXPECT_NEAR((box.top + box.bottom) / 2, at.y, 0.1) << placement.label;
                EXPECT_TRUE(box.isInside(viewport)) << placement.label;
            }
            expectLabelsApart(s);
            expectLabelsBesideSlices(s);
            if (count <= 21) {
                EXPECT_EQ(labeled, count);
            }
        }
    }
}

TEST(Labels, standBelowTheSlicesOfAGridAndTouchNone) {
    scene::Look look;
    look.view = scene::View::grid;
    for (const scene::Viewport viewport : kWindows) {
        for (const int count : {3, 11, 21, 61}) {
            const Scene s = composed("24-cell", count, viewport, look);
            SCOPED_TRACE(testing::Message() << viewport.width << " x " << viewport.height << ", " << count);
            int labeled = 0;
            for (const auto& placement : s.placements) {
                if (placement.label.empty()) continue;
                ++labeled;
                const LabelBox box(s, placement);
                const glm::dvec2 at = project(s, placement.position);
                EXPECT_NEAR((box.left + box.right) / 2, at.x, 1e-6) << placement.label;
                EXPECT_GT(box.top, at.y) << placement.label;
                EXPECT_TRUE(box.isInside(viewport)) << placement.label;
                for (const auto& slice : s.placements) {
                    const double radius = radiusOnScreen(s, slice.position, s.sliceRadius + s.ballRadius);
                    EXPECT_FALSE(box.overlapsDisk(project(s, slice.position), radius)) << placement.label;
                }
            }
            expectLabelsApart(s);
            if (count <= 21) {
                EXPECT_EQ(labeled, count);
            }
        }
    }
}

TEST(Labels, besideAColumnNameTheSectionOnlyWhereThereIsRoom) {
    scene::Look look;
    look.view = scene::View::column;
    const auto focusLabelIn = [&](scene::Viewport viewport) {
        return composed("5-cell", 21, viewport, look, 4).placements[10].label;
    };
    EXPECT_EQ(focusLabelIn({200, 800}), "w = 0.51");
    EXPECT_EQ(focusLabelIn({1280, 720}), "w = 0.51, tetrahedron");
}

TEST(Labels, areApartFromEverySide) {
    for (const scene::CameraOrbit& orbit : std::vector<scene::CameraOrbit>{
             {0, 0, 3}, {0, 0, 0.3}, {0.8, 0.2, 1}, {1.57, -0.46, 1}, {3.1, 0.5, 2}, {-0.4, 1, 0.5}, {0, -0.46, 1}}) {
        for (const int count : {5, 21, 201}) {
            scene::Look look;
            look.orbit = orbit;
            const Scene s = composed("24-cell", count, {1280, 720}, look);
            const std::vector<LabelBox> boxes = expectLabelsApart(s);
            const double strip = (s.coordinates.zero + s.coordinates.amplitude) * 720;
            for (std::size_t i = 1; i < boxes.size(); ++i) {
                EXPECT_TRUE(boxes[i].isInside({1280, 720}));
                EXPECT_LT(boxes[i].bottom, 720 - strip) << "no label covers the coordinates";
                EXPECT_FALSE(boxes[i].overlapsDisk({s.axes.x * 720, s.axes.y * 720}, s.axes.length * 720));
            }
            expectLabelsBesideSlices(s);
        }
    }
}

TEST(Axes, areCoveredByNoLabelThatIsMovedThere) {
    // Some of these camera positions bring the ends of the oval to the upper left corner, where the symbol of the axes
    // is.
    int near = 0;
    for (double azimuth = -0.6; azimuth < 0.6; azimuth += 0.05) {
        for (const double zoom : {0.8, 1.0, 1.3}) {
            scene::Look look;
            look.orbit = {azimuth, 0, zoom};
            const Scene s = composed("24-cell", 21, {1280, 720}, look);
            const glm::dvec2 center(s.axes.x * 720, s.axes.y * 720);
            for (const auto& placement : s.placements) {
                if (glm::distance(project(s, placement.labelAt), center) < 2 * s.axes.length * 720) ++near;
                if (placement.label.empty() || placement.focus) continue;
                EXPECT_FALSE(LabelBox(s, placement).overlapsDisk(center, s.axes.length * 720)) << azimuth;
            }
        }
    }
    EXPECT_GT(near, 0);
}

TEST(Labels, areAtTheFocusAndEveryKthSlice) {
    const auto labeledSlices = [](int count, double zoom) {
        scene::Look look;
        look.orbit.zoom = zoom;
        std::vector<int> offsets;
        for (const auto& placement : composed("24-cell", count, {1920, 1080}, look, 3).placements)
            if (!placement.label.empty()) offsets.push_back(placement.index - 3);
        return offsets;
    };
    EXPECT_EQ(labeledSlices(21, 1).size(), 21U);
    for (const int count : {61, 101, 201}) {
        const std::vector<int> offsets = labeledSlices(count, 1);
        ASSERT_GT(offsets.size(), 14U);
        const int step = offsets[1] - offsets[0];
        EXPECT_GT(step, 1);
        for (std::size_t i = 1; i < offsets.size(); ++i) EXPECT_EQ(offsets[i] - offsets[i - 1], step);
        EXPECT_NE(std::ranges::find(offsets, 0), offsets.end());
        // Where the slices are magnified, there is room for more labels.
        const std::vector<int> magnified = labeledSlices(count, 2);
        ASSERT_GT(magnified.size(), 1U);
        EXPECT_LT(magnified[1] - magnified[0], step);
    }
}

TEST(Labels, doNotMoveTheSlicesWhenTheFocusMovesOrTheyAreSwitchedOff) {
    scene::Look look;
    const scene::Camera camera = composed("24-cell", 21, {}, look).camera;
    for (const int focus : {-9, -4, 1, 12}) EXPECT_EQ(composed("24-cell", 21, {}, look, focus).camera, camera);
    look.parts.labels = false;
    EXPECT_EQ(composed("24-cell", 21, {}, look).camera, camera);
}

TEST(Labels, tellNeighborsApart) {
    for (const int count : {3, 21, 201}) {
        const Scene s = composed("600-cell", count);
        std::set<std::string> labels;
        std::size_t labeled = 0;
        for (const auto& placement : s.placements) {
            if (placement.label.empty()) continue;
            labels.insert(placement.label);
            ++labeled;
        }
        EXPECT_EQ(labels.size(), labeled);
    }
}

}  // namespace
