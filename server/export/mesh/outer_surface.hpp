#pragma once
// The outer surface of a slice that is not convex, or whose faces intersect.

#include "export/budget.hpp"
#include "export/mesh/mesh.hpp"
#include "slicing/slice_set.hpp"

namespace oval4d::exports {

/// Returns the outer surface of slice i, meshed by marching tetrahedra. The cubes are 1/128 of the slice's largest
/// dimension wide. A point is inside if the winding number of the slice's faces around the point is not 0 (the nonzero
/// rule). Points of the mesh lie on the faces, or a few steps of `grid` from them. Sharp edges are rounded by about the
/// width of a cube. `scale` is in millimeters per unit of the polytope. Returns an empty mesh if no corner of a cube is
/// inside, or if cubes are at most 64 steps of `grid` wide. Throws ExportRefused if `budget` is exceeded.
Mesh outerSurfaceOf(const slicing::SliceSet& slices, int i, double scale, const RoundingGrid& grid,
                    const ExportBudget& budget);

}  // namespace oval4d::exports
