#pragma once
// Drawings within bounds, for file formats that cannot hold large numbers.

#include <optional>

#include "export/drawing/drawing.hpp"

namespace oval4d::exports {

/// Returns the part of a shape that is nearer to both axes of the drawing than `farthest` units, or nothing if there is
/// none. Lines of slices close to the eye may reach that far beyond the drawing. A disk that reaches farther becomes a
/// polygon with 360 corners; images are returned unchanged, because they are in the drawing.
std::optional<DrawnShape> cutAtBounds(const DrawnShape& shape, double farthest);

}  // namespace oval4d::exports
