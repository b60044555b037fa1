#pragma once
// Vector drawings for printing. The writers of figure formats (PDF, SVG, TikZ) get only a Drawing.

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

// Lengths and positions are in units of the drawing (see Drawing::millimetersPerUnit()). Positions count from the upper
// left corner of the drawing; y points downward.

/// The default of Drawing::size in millimeters: about the width of the text on an A4 page.
inline constexpr double kDrawingSize = 170;

/// A straight line.
struct LineSegment {
    glm::dvec2 from, to;
    double width = 1;
    scene::Color color = 0;
    bool roundEnds = false;
    double opacity = 1;   ///< from 0 (invisible) to 1
    std::string id = {};  ///< id of the line in an SVG file; empty for a line without an id
};
/// A polyline with at least two points, and with round ends and corners.
struct Polyline {
    std::vector<glm::dvec2> points;
    double width = 1;
    scene::Color color = 0;
};
/// A filled polygon, which may cross itself. The nonzero winding rule says which parts are inside.
struct FilledPolygon {
    std::vector<glm::dvec2> corners;
    scene::Color color = 0;
    double opacity = 1;  ///< from 0 (invisible) to 1
};
/// A filled circle.
struct Disk {
    glm::dvec2 center;
    double radius = 1;
    scene::Color color = 0;
    double opacity = 1;  ///< from 0 (invisible) to 1
};
/// A line of text in ASCII. `at` is the middle of its baseline.
struct TextLine {
    glm::dvec2 at;
    double size = 7;  ///< font size
    scene::Color color = 0;
    std::string text;
};
/// A raster image in the rectangle from `topLeft` to `bottomRight`: a density strip (see scene::DensityPlot) or a panel
/// of a histogram (see slicing::CoordinateValueHistograms). The centers of the outer pixels lie on the edges of the
/// rectangle.
struct OpacityImage {
    glm::dvec2 topLeft, bottomRight;
    std::vector<std::uint8_t> alphas;  ///< opacities from 0 to 255, row by row from the top
    int columns = 1;                   ///< number of pixels in a row; must be at least 2, like rows()
    std::vector<scene::Color> colors;  ///< at least one color; the colors are spaced evenly from the first column to
                                       ///< the last, and interpolated in between

    int rows() const { return static_cast<int>(alphas.size()) / columns; }
    std::uint8_t alpha(int row, int column) const {
        return alphas[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                      static_cast<std::size_t>(column)];
    }
    /// Returns the color of a column of pixels, interpolated between the nearest entries of `colors`.
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
using DrawnShape = std::variant<LineSegment, Polyline, FilledPolygon, Disk, TextLine, OpacityImage>;

/// A named group of shapes. Later shapes cover earlier shapes.
struct ShapeGroup {
    std::string id;  ///< name of the group in the file; unique in a drawing
    std::vector<DrawnShape> shapes;
};

/// A drawing for white paper, without a background.
struct Drawing {
    std::string title;
    double width = 0, height = 0;
    std::vector<ShapeGroup> groups;  ///< later groups cover earlier groups
    double size = kDrawingSize;      ///< the larger of the width and the height on paper, in millimeters

    /// Returns the length on paper of one unit of the drawing, in millimeters.
    double millimetersPerUnit() const { return size / std::max(width, height); }
};

/// The width of drawings in units of the drawing. At the size kDrawingSize, a unit is about 1/72 inch.
inline constexpr double kDrawingWidth = 480;
inline constexpr double kDrawingMargin = 12;
inline constexpr scene::Color kDrawingText = 0x444444;

}  // namespace oval4d::exports
