#pragma once
// Cuts shapes of drawings at the borders of a square, for file formats that cannot contain large numbers.

#include <optional>

#include "export/drawing/drawing.hpp"

namespace oval4d::exports {

/// Returns the part of a shape inside the square |x|, |y| < `farthest`, in units of the drawing; an empty optional if
/// no part is inside. Shapes of slices close to the eye may extend far beyond the drawing, and file formats limit the
/// size of numbers. A cut disk becomes the part of a polygon with 360 corners. A polyline that leaves the square and
/// returns follows the border in between. A text is returned unchanged if TextLine::at is inside. Images are returned
/// unchanged, because they lie within the drawing.
std::optional<DrawnShape> cutAtBounds(const DrawnShape& shape, double farthest);

}  // namespace oval4d::exports
