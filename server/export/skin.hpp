#pragma once
// The outer skin of a slice whose faces cross each other, or that is not convex.

#include "export/budget.hpp"
#include "export/mesh.hpp"
#include "geometry/slice_set.hpp"

namespace oval4d::exports {

/// The surface of all places around which the slice's faces wind a number of times that is not 0 (the nonzero rule),
/// meshed by marching tetrahedra: its points lie on the faces, and its edges are rounded by the width of a cube, the
/// 128th part of the slice. Empty where no cube's corner is inside.
Mesh skinOf(const geometry::SliceSet& slices, int i, double scale, const Grid& grid, const Budget& budget);

}  // namespace oval4d::exports
