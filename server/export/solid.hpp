#pragma once
// The filled body of a slice.

#include "export/budget.hpp"
#include "export/mesh.hpp"
#include "geometry/slice_set.hpp"

namespace oval4d::exports {

/// The body that slice i bounds, `scale` millimetres to the polytope's unit. A convex slice keeps its faces to within
/// the grid; of any other one, whose faces may cross each other, the outer skin (see skin.hpp). Empty where the slice
/// has no volume on the grid.
Mesh solidOf(const geometry::SliceSet& slices, int i, double scale, const Grid& grid, const Budget& budget);

}  // namespace oval4d::exports
