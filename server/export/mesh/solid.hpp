#pragma once
// Filled bodies of slices.

#include "export/budget.hpp"
#include "export/mesh/mesh.hpp"
#include "slicing/slice_set.hpp"

namespace oval4d::exports {

/// Returns the body that the faces of slice i enclose. The body of a convex slice has the same faces as the slice; its
/// coordinates are rounded to the grid. The body of any other slice, whose faces may intersect, is bounded by its outer
/// surface (see outer_surface.hpp). Returns an empty mesh if the slice has no volume after rounding. `scale` is in
/// millimeters per unit of the polytope.
Mesh solidOf(const slicing::SliceSet& slices, int i, double scale, const Grid& grid, const Budget& budget);

}  // namespace oval4d::exports
