#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "scene/composer.hpp"
#include "unit/slicing/support.hpp"

namespace {

using namespace oval4d;
using scene::Scene;
using support::named;

/// Returns a scene without its slices. By default, the outermost of them touch the polytope.
Scene composed(std::string_view name, int count = 21, scene::Viewport viewport = {}, scene::Look look = {},
               int focus = 0, double spacing = 0) {
    const auto& p = named(name);
    slicing::SliceSet slices;
    if (spacing == 0) spacing = 2 * p.circumradius / (count == 1 ? 2 : count - 1);
    slicing::PolytopeSlicer().slice(p, {}, {focus - (count - 1) / 2, count, spacing}, slices);
    Scene s;
    scene::Composer().compose(support::objectOf(p), {}, slices, focus, look, viewport, s);
    s.slices = &slicing::kNoSlices;
    return s;
}

/// Returns pixel coordinates, measured from the upper left corner.
glm::dvec2 project(const Scene& s, const glm::dvec3& world) {
    const double aspect = double(s.viewport.width) / s.viewport.height;
    const glm::dvec4 clip = s.camera.projection(aspect) * s.camera.view() * glm::dvec4(world, 1);
    return {(clip.x / clip.w + 1) / 2 * s.viewport.width, (1 - clip.y / clip.w) / 2 * s.viewport.height};
}

TEST(Highlight, ColorsTheCellThatIsHighlightedAndNoOther) {
    const auto& p = named("24-cell");
    slicing::SliceSet slices;
    slicing::PolytopeSlicer().slice(p, {}, {-1, 3, 0.5}, slices);
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

TEST(Oval, followsTheFocus) {
    const Scene s = composed("5-cell", 21, {}, {}, 4);
    EXPECT_EQ(s.placements[10].index, 4);
    EXPECT_TRUE(s.placements[10].focus);
    EXPECT_EQ(s.placements[10].position, glm::dvec3(0));
    EXPECT_EQ(s.placements[6].label, "0");
    EXPECT_EQ(s.placements[10].label, "w = 0.51, tetrahedron");
}

TEST(Labels, areEmptyWhenSwitchedOff) {
    scene::Look look;
    for (const auto& placement : composed("8-cell", 21, {}, look).placements) EXPECT_FALSE(placement.label.empty());
    look.parts.labels = false;
    for (const auto& placement : composed("8-cell", 21, {}, look).placements) EXPECT_TRUE(placement.label.empty());
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

/// Returns the circle on the screen that a sphere about a world position appears as, nearly: its radius in pixels.
double radiusOnScreen(const Scene& s, const glm::dvec3& center, double radius) {
    const double depth = -(s.camera.view() * glm::dvec4(center, 1)).z;
    return radius / depth * s.viewport.height / (2 * std::tan(s.camera.fieldOfView / 2));
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

TEST(ObjectProjection, standsInSightAndClearOfTheSlices) {
    for (const scene::Viewport viewport :
         {scene::Viewport{1280, 720}, {1920, 1080}, {640, 640}, {375, 667}, {3000, 800}}) {
        for (const char* name : {"5-cell", "120-cell"}) {
            for (const int count : {1, 3, 5, 21, 61, 201}) {
                for (const auto view : {scene::View::oval, scene::View::single, scene::View::strip}) {
                    scene::Look look;
                    look.view = view;
                    look.projection.kind = scene::ProjectionKind::perspective;
                    const Scene s = composed(name, count, viewport, look);
                    ASSERT_TRUE(s.projectionPlacement.shown);
                    const auto& [shown, position, sphere] = s.projectionPlacement;
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

TEST(ObjectProjection, hasTheSectionOfTheFocusOrOfAllHyperplanes) {
    scene::Look look;
    EXPECT_FALSE(composed("24-cell", 21, {}, look).projectionPlacement.shown);
    look.projection.kind = scene::ProjectionKind::orthogonal;
    const Scene focus = composed("24-cell", 21, {}, look);
    ASSERT_EQ(focus.projection.parts.size(), 2U);
    EXPECT_EQ(focus.projection.parts[1].barColor, scene::style().axes[3]);
    look.parts.sections = true;
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

TEST(Coordinates, holdEveryVertexInsideTheViewport) {
    for (const auto& entry : polytopes::catalogue().first(6)) {
        const Scene s = composed(entry.name);
        const auto& c = s.coordinates;
        EXPECT_GE(std::size_t(c.rows) * c.perRow, entry.vertices);
        EXPECT_GE(c.left, 0);
        EXPECT_EQ(c.density, entry.vertices > scene::kMaxVerticesAsLines);
        EXPECT_LE(c.left + c.columnStep * c.perRow, 1280.0 / 720 + 1e-9);
        EXPECT_LE(c.left + 3 * c.lineStep + c.lineWidth, 1280.0 / 720);
        EXPECT_LE(c.density ? 0 : 4 * c.lineStep, c.columnStep);
        EXPECT_GT(c.lineWidth * 720, 0.7) << entry.name;  // at least about one pixel
        EXPECT_GE(c.zero - c.amplitude - (c.rows - 1) * c.rowStep, 0);
        EXPECT_LT(c.zero + c.amplitude, 0.3);
    }
    EXPECT_TRUE(composed("5-cell").coordinates.named);
}

TEST(Coordinates, stayWithinWindowsThatAreHardlyWiderThanTheirMargins) {
    for (const scene::Viewport viewport : {scene::Viewport{16, 200}, {16, 8192}, {100, 1250}}) {
        for (const char* name : {"5-cell", "24-cell", "120-cell"}) {
            const auto layout = composed(name, 21, viewport).coordinates;
            const double aspect = double(viewport.width) / viewport.height;
            EXPECT_GE(layout.rows, 1);
            EXPECT_LE(layout.rows, 6);
            EXPECT_GE(layout.lineStep, 0) << name;
            if (layout.density) continue;
            EXPECT_GT(layout.columnStep, 0) << name;
            EXPECT_LE(layout.columnStep * layout.perRow, aspect * (1 + 1e-9)) << name;
        }
    }
}

/// A label with its plate on the screen, in pixels from the upper left corner. The text is in DejaVu Sans.
struct LabelBox {
    double left, right, top, bottom;

    LabelBox(const Scene& s, const scene::SlicePlacement& placement) {
        double width = 0;  // in font sizes
        for (const char c : placement.label) {
            const bool continuation = (c & 0xC0) == 0x80;  // of the sign U+2212, whose width is 0.838
            const bool narrow = c == '.' || c == ',' || c == ' ';
            const bool letter = 'a' <= c && c <= 'z' && c != 'w';  // at most 0.6 on the average of a name
            if (!continuation) width += narrow ? 0.318 : letter ? 0.6 : '0' <= c && c <= '9' ? 0.636 : 0.838;
        }
        const double size = scene::style().textHeight * placement.labelSize * s.viewport.height, digits = 0.729 * size;
        const glm::dvec2 at = project(s, placement.labelAt);
        const double marginX = (placement.focus ? 0.9 : 0.25) * digits,
                     marginY = (placement.focus ? 0.6 : 0.13) * digits;
        left = at.x - width * size / 2 - marginX, right = at.x + width * size / 2 + marginX;
        top = at.y - marginY, bottom = at.y + digits + marginY;
    }
    bool overlaps(const LabelBox& b) const {
        return left < b.right && b.left < right && top < b.bottom && b.top < bottom;
    }
    bool overlapsDisk(const glm::dvec2& center, double radius) const {
        const glm::dvec2 nearest = glm::clamp(center, glm::dvec2(left, top), glm::dvec2(right, bottom));
        return glm::distance(nearest, center) < radius;
    }
    bool isInside(const scene::Viewport& viewport) const {
        return left >= 0 && right <= viewport.width && top >= 0 && bottom <= viewport.height;
    }
};

/// Expects the focus slice to have a label, and no label to overlap another. Returns the labels that are drawn, with
/// that of the focus slice first.
std::vector<LabelBox> expectLabelsApart(const Scene& s) {
    std::vector<LabelBox> boxes;
    for (const bool focus : {true, false}) {
        for (const auto& placement : s.placements) {
            if (!placement.drawn || placement.focus != focus || placement.label.empty()) continue;
            const LabelBox box(s, placement);
            for (const LabelBox& other : boxes) EXPECT_FALSE(box.overlaps(other)) << placement.label;
            boxes.push_back(box);
        }
        EXPECT_FALSE(boxes.empty());
    }
    return boxes;
}

const std::vector<scene::Viewport> kWindows{{1280, 720}, {1920, 1080}, {2560, 1440}, {3000, 800},
                                            {640, 640},  {375, 667},   {320, 568},   {667, 375}};

TEST(Labels, areInThePictureAndApart) {
    for (const scene::Viewport viewport : kWindows) {
        for (const int count : {1, 3, 5, 11, 21, 41, 61, 101, 151, 201}) {
            for (const double spacing : {0.0, 1.0 / 4096, 1e-8, 1e3}) {
                for (const auto view : {scene::View::oval, scene::View::single, scene::View::strip}) {
                    for (const bool whole : {false, true}) {
                        scene::Look look;
                        look.view = view;
                        look.parts.coordinates = !whole;
                        if (whole) look.projection.kind = scene::ProjectionKind::perspective;
                        const Scene s = composed("24-cell", count, viewport, look, whole ? 5 : 0, spacing);
                        SCOPED_TRACE(testing::Message() << viewport.width << " x " << viewport.height << ", " << count
                                                        << " slices, " << spacing << ", " << whole);
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
                    const auto& [shown, position, sphere] = s.projectionPlacement;
                    EXPECT_TRUE(shown && isOutside(project(s, position), radiusOnScreen(s, position, sphere)));
                }
                for (const LabelBox& box : expectLabelsApart(s)) {
                    EXPECT_TRUE(box.isInside(viewport));
                    EXPECT_TRUE(box.right <= left || box.left >= right || box.bottom <= top || box.top >= bottom);
                }
            }
        }
    }
}

// Expects the labels of all slices but the focus slice to stand beside the other slices, whose balls may touch them.
void expectLabelsBesideSlices(const Scene& s) {
    for (const auto& placement : s.placements) {
        if (!placement.drawn || placement.focus || placement.label.empty()) continue;
        LabelBox text(s, placement);
        const double margin = 0.4 * (text.bottom - text.top);  // of the plate behind the text, and more
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
    // Some of these orbits bring the ends of the oval to the upper left corner.
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

TEST(Axes, areBesideTheSliceAndTheProjection) {
    for (const scene::Viewport viewport :
         {scene::Viewport{768, 1024}, {900, 600}, {640, 640}, {1280, 720}, {375, 667}}) {
        for (const auto view : {scene::View::single, scene::View::matrix}) {
            for (const bool whole : {false, true}) {
                scene::Look look;
                look.view = view;
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
        // There is room for more of them where the slices are magnified.
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
