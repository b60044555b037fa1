#pragma once
// Vector drawings for printing. The writers of figure formats get a Drawing and no other data.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include <glm/vec2.hpp>

#include "scene/color.hpp"

namespace oval4d::exports {

// Lengths and positions are in units of the drawing (see Drawing::millimetersPerUnit()). Positions are measured from
// the upper left corner of the drawing, with y downward.

/// The default of Drawing::size in millimeters: about the width of the text on a page of A4.
inline constexpr double kDrawingSize = 170;

/// A straight line.
struct Line {
    glm::dvec2 from, to;
    double width = 1;
    scene::Color color = 0;
    bool roundEnds = false;
    double opacity = 1;   ///< 0 … 1
    std::string id = {};  ///< the id of the line in an SVG file; may be empty
};
/// A polygonal line of at least two points, with round ends and corners.
struct Polyline {
    std::vector<glm::dvec2> points;
    double width = 1;
    scene::Color color = 0;
};
/// A polygon that may cross itself, filled by the nonzero winding rule.
struct FilledPolygon {
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
    double size = 7;  ///< the font size
    scene::Color color = 0;
    std::string text;
};
/// A raster image of a density strip (see scene::DensityPlot) or of a panel of a histogram (see
/// slicing::CoordinateValueHistograms), in the rectangle from `topLeft` to `bottomRight`. The centers of the first and
/// the last column lie on the left and right edges of the rectangle, and the centers of the first and the last row on
/// its upper and lower edges.
struct OpacityImage {
    glm::dvec2 topLeft, bottomRight;
    std::vector<std::uint8_t> alphas;  ///< opacities from 0 to 255, row by row from the top
    int columns = 1;                   ///< must be at least 2, and so must rows()
    std::vector<scene::Color> colors;  ///< at least one; spaced evenly from the first column to the last, and
                                       ///< interpolated between these positions

    int rows() const { return static_cast<int>(alphas.size()) / columns; }
    std::uint8_t alpha(int row, int column) const {
        return alphas[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                      static_cast<std::size_t>(column)];
    }
    /// Returns the color of a column of pixels, interpolated between those of `colors`.
    scene::Color colorOfPixelColumn(int column) const {
        const std::size_t last = colors.size() - 1;
        const double at = static_cast<double>(column) * static_cast<double>(last) / (columns - 1);
        const auto first = std::min(static_cast<std::size_t>(at), last);
        scene::Color mixed = 0;
        for (const int shift : {16, 8, 0}) {
            const double from = colors[first] >> shift & 255U, to = colors[std::min(first + 1, last)] >> shift & 255U;
            const double channel = from + (at - static_cast<double>(first)) * (to - from);
            mixed |= static_cast<scene::Color>(std::lround(channel)) << shift;
        }
        return mixed;
    }
};
using DrawnShape = std::variant<Line, Polyline, FilledPolygon, Disk, TextLine, OpacityImage>;

/// A named group of shapes. Later shapes cover earlier ones.
struct ShapeGroup {
    std::string id;  ///< identifies the group in the file; unique in a drawing
    std::vector<DrawnShape> shapes;
};

/// A drawing for white paper. It has no background.
struct Drawing {
    std::string title;
    double width = 0, height = 0;
    std::vector<ShapeGroup> groups;  ///< later groups cover earlier ones
    double size = kDrawingSize;      ///< the larger of width and height on paper, in millimeters

    /// Returns the length on paper of one unit of the drawing, in millimeters.
    double millimetersPerUnit() const { return size / std::max(width, height); }
};

/// The width of drawings in units. If the drawing is as large as kDrawingSize, a unit is about 1/72 inch.
inline constexpr double kDrawingWidth = 480;
inline constexpr double kDrawingMargin = 12;
inline constexpr scene::Color kDrawingText = 0x444444;

}  // namespace oval4d::exports
