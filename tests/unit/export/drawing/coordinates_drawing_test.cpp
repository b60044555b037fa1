// Tests of the highlighted element in drawings of the parallel coordinates.

#include "export/drawing/coordinates_drawing.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string_view>
#include <variant>
#include <vector>

#include <gtest/gtest.h>
#include <glm/vec2.hpp>

#include "scene/composer.hpp"
#include "slicing/slicer.hpp"
#include "unit/slicing/support.hpp"

namespace {

using namespace oval4d;

// A polytope with the drawing of its parallel coordinates.
struct DrawnPolytope {
    slicing::Object object;
    slicing::SliceSet slices;
    scene::Scene scene;
    exports::Drawing drawing;

    DrawnPolytope(std::string_view name, bool highlightsACell) : object(support::objectOf(support::named(name))) {
        std::mt19937 random(4);
        const geometry::Rotation orientation = support::randomRotation(random);
        slicing::Slicer().slice(object, orientation, {0, 1, 1}, {}, {}, slices);
        scene::Look look;
        if (highlightsACell) look.highlight = slicing::Element{slicing::ElementKind::cell, 3};
        scene::Composer().compose(object, orientation, slices, 0, look, {}, scene);
        drawing = exports::drawCoordinates(scene, object, orientation);
    }
    DrawnPolytope(const DrawnPolytope&) = delete;
    DrawnPolytope& operator=(const DrawnPolytope&) = delete;

    // Returns the shapes of the group `id`, or null if there is no such group.
    const std::vector<exports::DrawnShape>* group(std::string_view id) const {
        const auto found = std::ranges::find(drawing.groups, id, &exports::ShapeGroup::id);
        return found == drawing.groups.end() ? nullptr : &found->shapes;
    }
};

TEST(CoordinatesDrawing, HasNoHighlightWithoutAHighlightedElement) {
    for (const char* name : {"24-cell", "120-cell"}) {
        EXPECT_EQ(DrawnPolytope(name, false).group("highlight"), nullptr) << name;
    }
}

TEST(CoordinatesDrawing, HasALineOverTheDensityStripForEachHighlightedVertex) {
    const DrawnPolytope drawn("120-cell", true);
    const auto* axes = drawn.group("axes");
    const auto* highlight = drawn.group("highlight");
    ASSERT_TRUE(axes != nullptr && highlight != nullptr);
    std::vector<exports::LineSegment> scales;
    for (const exports::DrawnShape& shape : *axes)
        if (const auto* line = std::get_if<exports::LineSegment>(&shape)) scales.push_back(*line);
    ASSERT_EQ(scales.size(), 4U);
    const std::vector<std::uint32_t>& own = drawn.scene.highlight.ownVertices;
    ASSERT_EQ(own.size(), 20U) << "a dodecahedron";
    ASSERT_EQ(highlight->size(), own.size());
    for (std::size_t i = 0; i < own.size(); ++i) {
        const auto& line = std::get<exports::Polyline>((*highlight)[i]);
        EXPECT_EQ(line.color, drawn.scene.style().highlight);
        ASSERT_EQ(line.points.size(), 4U);
        for (int k = 0; k < 4; ++k) {
            const auto axis = static_cast<std::size_t>(k);
            const double top = scales[axis].from.y, bottom = scales[axis].to.y;
            const double value = drawn.slices.rotatedVertices[own[i]][k] / drawn.scene.circumradius;
            EXPECT_NEAR(line.points[axis].x, scales[axis].from.x, 1e-9);
            EXPECT_NEAR(line.points[axis].y, bottom + (value + 1) / 2 * (top - bottom), 1e-9);
        }
    }
}

TEST(CoordinatesDrawing, HasABandBehindTheLinesOfEachHighlightedVertex) {
    const DrawnPolytope drawn("24-cell", true);
    const auto* highlight = drawn.group("highlight");
    ASSERT_NE(highlight, nullptr);
    const std::vector<std::uint32_t>& own = drawn.scene.highlight.ownVertices;
    ASSERT_EQ(own.size(), 6U) << "an octahedron";
    ASSERT_EQ(highlight->size(), own.size());
    for (const char* axis : {"x", "y", "z", "w"}) {
        const auto* lines = drawn.group(axis);
        ASSERT_TRUE(lines != nullptr && lines->size() == 24) << axis;
        for (std::size_t v = 0; v < lines->size(); ++v) {
            const auto& line = std::get<exports::LineSegment>((*lines)[v]);
            const auto holds = [&](const exports::DrawnShape& shape) {
                const std::vector<glm::dvec2>& corners = std::get<exports::FilledPolygon>(shape).corners;
                const glm::dvec2 least = corners[0] - 1e-9, most = corners[2] + 1e-9;
                return least.x < line.from.x && line.from.x < most.x && least.y < std::min(line.from.y, line.to.y) &&
                       std::max(line.from.y, line.to.y) < most.y;
            };
            EXPECT_EQ(std::ranges::count_if(*highlight, holds),
                      std::ranges::binary_search(own, static_cast<std::uint32_t>(v)) ? 1 : 0)
                << axis << v;
        }
    }
}

}  // namespace
