#pragma once
// Filled bodies of slices.

#include "export/budget.hpp"
#include "export/mesh/mesh.hpp"
#include "slicing/slice_set.hpp"

namespace oval4d::exports {

/// The body bounded by slice i. A convex slice keeps its faces, up to rounding to the grid; any other slice, whose
/// faces may intersect, gives its outer surface (see skin.hpp). Empty if the slice has no volume on the grid. `scale`:
/// millimeters per unit of the polytope.
Mesh solidOf(const slicing::SliceSet& slices, int i, double scale, const Grid& grid, const Budget& budget);

}  // namespace oval4d::exports
