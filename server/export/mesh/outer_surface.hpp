#pragma once
// The outer surface of a slice that is not convex or whose faces intersect.

#include "export/budget.hpp"
#include "export/mesh/mesh.hpp"
#include "slicing/slice_set.hpp"

namespace oval4d::exports {

/// Returns the outer surface of slice i, meshed by marching tetrahedra. A point is inside the surface if the winding
/// number of the slice's faces around the point is not 0 (the nonzero rule). The points of the mesh lie on the faces;
/// its edges are rounded by the width of a cube, 1/128 of the slice's largest dimension. Returns an empty mesh if no
/// corner of a cube is inside, or if a cube is at most 64 grid steps wide. `scale`: millimeters per unit of the
/// polytope.
Mesh outerSurfaceOf(const slicing::SliceSet& slices, int i, double scale, const Grid& grid, const Budget& budget);

}  // namespace oval4d::exports
