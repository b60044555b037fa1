#pragma once
// Cuts the shapes of drawings at bounds, for file formats that cannot contain large numbers.

#include <optional>

#include "export/drawing/drawing.hpp"

namespace oval4d::exports {

/// Returns the part of a shape in the square −farthest < x, y < farthest, in units of the drawing; an empty optional if
/// no part is in it. Shapes of slices close to the eye may reach so far beyond the drawing. A disk that is cut becomes
/// a polygon with 360 corners. A polygonal line that leaves the square and returns follows its border in between.
/// Images are returned unchanged, because they lie within the drawing.
std::optional<DrawnShape> cutAtBounds(const DrawnShape& shape, double farthest);

}  // namespace oval4d::exports
