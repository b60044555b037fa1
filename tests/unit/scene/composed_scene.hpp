#pragma once
// Helpers of the tests of scenes: they compose scenes of polytopes, and find the places of their parts in the picture.

#include <cmath>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "scene/composer.hpp"
#include "unit/slicing/support.hpp"

namespace oval4d::scene {

/// Viewports of many shapes and sizes, for tests of the layout.
inline const std::vector<Viewport> kWindows{{1280, 720}, {1920, 1080}, {2560, 1440}, {3000, 800},
                                            {640, 640},  {375, 667},   {320, 568},   {667, 375}};

/// Returns the scene of a polytope, without its slices. By default, the hyperplanes of the outermost slices touch the
/// circumscribed sphere.
inline Scene composed(std::string_view name, int count = 21, Viewport viewport = {}, Look look = {}, int focus = 0,
                      double spacing = 0) {
    const auto& p = support::named(name);
    slicing::SliceSet slices;
    if (spacing == 0) spacing = 2 * p.circumradius / (count == 1 ? 2 : count - 1);
    slicing::CellComplexSlicer().slice(p, {}, {focus - (count - 1) / 2, count, spacing}, slices);
    Scene s;
    Composer().compose(support::objectOf(p), {}, slices, focus, look, viewport, s);
    s.slices = &slicing::kNoSlices;
    return s;
}

/// Returns the place in the picture of a point in world space, in pixels from the upper left corner.
inline glm::dvec2 project(const Scene& s, const glm::dvec3& world) {
    const double aspect = double(s.viewport.width) / s.viewport.height;
    const glm::dvec4 clip = s.camera.projection(aspect) * s.camera.view() * glm::dvec4(world, 1);
    return {(clip.x / clip.w + 1) / 2 * s.viewport.width, (1 - clip.y / clip.w) / 2 * s.viewport.height};
}

/// Returns the approximate radius, in pixels, of a sphere in the picture. `center` and `radius` are in world space.
inline double radiusOnScreen(const Scene& s, const glm::dvec3& center, double radius) {
    const double depth = -(s.camera.view() * glm::dvec4(center, 1)).z;
    return radius / depth * s.viewport.height / (2 * std::tan(s.camera.fieldOfView / 2));
}

/// The box of a label with its plate in the picture, in pixels from the upper left corner. The text is in DejaVu Sans.
struct LabelBox {
    double left, right, top, bottom;

    LabelBox(const Scene& s, const SlicePlacement& placement) {
        double width = 0;  // the width of the text, as a multiple of the font size
        for (const char c : placement.label) {
            // A later byte of the UTF-8 character U+2212, whose first byte counts 0.838.
            const bool continuation = (c & 0xC0) == 0x80;
            const bool narrow = c == '.' || c == ',' || c == ' ';
            // The mean width of the letters in a name is at most 0.6.
            const bool letter = 'a' <= c && c <= 'z' && c != 'w';
            if (!continuation) width += narrow ? 0.318 : letter ? 0.6 : '0' <= c && c <= '9' ? 0.636 : 0.838;
        }
        const double size = style().textHeight * placement.labelSize * s.viewport.height, digits = 0.729 * size;
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
    bool isInside(const Viewport& viewport) const {
        return left >= 0 && right <= viewport.width && top >= 0 && bottom <= viewport.height;
    }
};

/// Expects that the focus slice has a label, and that no label overlaps another. Returns the labels that are drawn,
/// with that of the focus slice first.
inline std::vector<LabelBox> expectLabelsApart(const Scene& s) {
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

}  // namespace oval4d::scene
