#pragma once
// Drawings for printing, made of lines and areas that are sharp at any size. Writers of figure formats need no other
// data.

#include <array>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include <glm/vec2.hpp>

#include "scene/color.hpp"

namespace oval4d::exports {

// Lengths are in points (1/72 inch). Positions are measured from the upper left corner, y downward.

/// A straight line.
struct Line {
    glm::dvec2 from, to;
    double width = 1;
    scene::Color color = 0;
    bool roundEnds = false;
    double opacity = 1;   ///< 0 … 1
    std::string id = {};  ///< identifies the line in the file; may be empty
};
/// The interior of a polygon.
struct Area {
    std::vector<glm::dvec2> corners;
    scene::Color color = 0;
    double opacity = 1;  ///< 0 … 1
};
/// The interior of a circle.
struct Disk {
    glm::dvec2 center;
    double radius = 1;
    scene::Color color = 0;
    double opacity = 1;  ///< 0 … 1
};
/// A line of text, centered at a position on its baseline. The characters are ASCII.
struct TextLine {
    glm::dvec2 at;
    double size = 7;  ///< of the font
    scene::Color color = 0;
    std::string text;
};
/// A density strip (see scene::DensityPlot) in a rectangle. The first and the last column are centered on the left and
/// right edges, the first and the last row on the upper and lower edges.
struct DensityImage {
    glm::dvec2 topLeft, bottomRight;
    std::vector<std::uint8_t> tones;         ///< row by row; opacities from 0 to 255
    std::array<scene::Color, 4> axisColors;  ///< of x, y, z and w; columns between them have mixed colors
};
using Shape = std::variant<Line, Area, Disk, TextLine, DensityImage>;

/// Shapes that belong together. Later shapes cover earlier ones.
struct ShapeGroup {
    std::string id;  ///< identifies the group in the file; unique in a drawing
    std::vector<Shape> shapes;
};

/// A drawing on white or transparent ground.
struct Drawing {
    std::string title;
    double width = 0, height = 0;
    std::vector<ShapeGroup> groups;  ///< later groups cover earlier ones
};

/// The width of drawings: that of a text column of a printed page.
inline constexpr double kDrawingWidth = 480;
inline constexpr double kDrawingMargin = 12;
inline constexpr scene::Color kDrawingText = 0x444444;

}  // namespace oval4d::exports
