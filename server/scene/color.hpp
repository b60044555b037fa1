#pragma once
// Chooses the colors of cells, of the levels of fields, and of values.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec4.hpp>

#include "geometry/rotation.hpp"
#include "scene/look.hpp"
#include "slicing/object.hpp"

namespace oval4d::scene {

/// An sRGB color: 0xRRGGBB.
using Color = std::uint32_t;

/// Returns the color as CSS, SVG and OpenSCAD write it: "#rrggbb", in lower-case hexadecimal digits.
std::string cssColor(Color color);

/// Returns the contrast of two colors by WCAG 2.2: from 1 (equal luminance) to 21 (black and white).
double contrast(Color a, Color b);

// The following functions with a parameter `scheme` return colors of the same hue for both color schemes. A color for
// the light scheme has a contrast to white of at least 3.6. Even if shading brightens such a color, its contrast to
// white and to a nearly white background is at least 3.

/// Returns the color that Coloring::cell_type gives to all cells of the type `type`. `type` is an index less than
/// `count`, the number of the object's cell types.
Color cellTypeColor(std::size_t type, std::size_t count, ColorScheme scheme = ColorScheme::dark);

/// Returns the color that Coloring::cell gives to the surface of level i of a field with `count` levels.
Color levelColor(std::size_t i, std::size_t count, ColorScheme scheme = ColorScheme::dark);

/// Returns the color of cells and surfaces whose color has no meaning, as with Coloring::plain.
Color plainColor(ColorScheme scheme = ColorScheme::dark);

/// Returns the color of a value on a diverging scale: blue at −1, gray at 0, amber at 1. Values outside this range have
/// the color of the nearer end; NaN has the gray of 0.
Color divergingColor(double value, ColorScheme scheme = ColorScheme::dark);

/// Returns the color of a value on a sequential scale, from dark blue at 0 through green to light yellow at 1. In the
/// light scheme, the yellow is darkened to olive. Values outside this range have the color of the nearer end.
Color sequentialColor(double value, ColorScheme scheme = ColorScheme::dark);

/// Returns the color of points without a value: gray.
Color noValueColor();

/// Computes the colors of an object's cells. Keeps the data that do not depend on the orientation from one call to the
/// next.
class CellColorAssigner {
  public:
    /// Writes one color per cell to `out`, as `coloring` specifies. Every call must get the vector that the previous
    /// call wrote, because colors that stay the same are not written again.
    ///
    /// - Coloring::cell: if there are at most 24 cells, all have different colors. If there are more, the cells along
    ///   one Hopf fiber (a great circle) share a color.
    /// - Coloring::cell_type: the color is cellTypeColor().
    /// - Coloring::w: the color is divergingColor() for the w of the cell's center after the rotation, divided by the
    ///   greatest distance of any center from the origin.
    /// - Coloring::light: one hue, whose lightness depends on the angle between the cell's outward normal after the
    ///   rotation and the direction toward a light in four dimensions.
    /// - Other values: the color is plainColor().
    void updateCellColors(const slicing::Object& object, Coloring coloring, ColorScheme scheme,
                          const geometry::Rotation& orientation, std::vector<Color>& out);

    /// Writes to `out` the colors of the 2-faces of a surface, which has no cells. With Coloring::w, there is one color
    /// per 2-face: divergingColor() for the w of its center, as for cells. Otherwise, there is a single color for all
    /// 2-faces: plainColor(). Every call of updateCellColors() or of this function must get the same vector as `out`.
    void updateFaceColors(const slicing::Object& object, Coloring coloring, ColorScheme scheme,
                          const geometry::Rotation& orientation, std::vector<Color>& out);

  private:
    bool prepareColors(const slicing::Object& object, Coloring coloring, ColorScheme scheme, std::size_t count,
                       std::vector<Color>& out);
    void colorByWOfCenters(const slicing::Object& object, bool isNew, const geometry::Rotation& orientation,
                           std::vector<Color>& out);
    void scaleDirections(double circumradius);
    void setDirectionsToNormals(const slicing::Object& object);
    void colorByDirection(const std::array<Color, 255>& scale, const glm::dvec4& axis, std::vector<Color>& out) const;

    std::uint64_t assignedFor_ = 0;  // the serial number of the object whose cells or 2-faces were colored last
    Coloring coloring_ = Coloring::cell;
    ColorScheme scheme_ = ColorScheme::dark;
    // Per cell or 2-face, before the rotation. With Coloring::w: its center, divided by the greatest distance of any
    // center from the origin. With Coloring::light: its unit normal.
    std::vector<glm::dvec4> directions_;
};

}  // namespace oval4d::scene
