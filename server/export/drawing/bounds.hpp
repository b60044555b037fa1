#pragma once
// Cuts the shapes of drawings at bounds, for file formats that cannot contain large numbers.

#include <optional>

#include "export/drawing/drawing.hpp"

namespace oval4d::exports {

/// Returns the part of a shape in the square −farthest < x, y < farthest, in units of the drawing; an empty optional if
/// no part is in the square. Shapes of slices close to the eye may extend far beyond the drawing, and formats limit the
/// size of numbers. A disk that is cut becomes a polygon with 360 corners. A polygonal line that leaves the square and
/// returns follows the border of the square in between. Images are returned unchanged, because they lie within the
/// drawing.
std::optional<DrawnShape> cutAtBounds(const DrawnShape& shape, double farthest);

}  // namespace oval4d::exports
