#pragma once
// Filled bodies of slices.

#include "export/budget.hpp"
#include "export/mesh/mesh.hpp"
#include "slicing/slice_set.hpp"

namespace oval4d::exports {

/// Returns the body that the faces of slice i enclose. The body of a convex slice has the faces of the slice with
/// coordinates rounded to the grid or, if the rounding makes faces degenerate, is the convex hull of the rounded
/// points. The body of any other slice, whose faces may intersect, is bounded by its outer surface (see
/// outer_surface.hpp). `scale` is in millimeters per unit of the polytope. Returns an empty mesh if the rounded body
/// has no volume (see hasVolume()). Throws ExportRefused if `budget` is exceeded.
Mesh solidOf(const slicing::SliceSet& slices, int i, double scale, const Grid& grid, const Budget& budget);

}  // namespace oval4d::exports
