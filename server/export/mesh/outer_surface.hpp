#pragma once
// The outer surface of a slice that is not convex or whose faces intersect.

#include "export/budget.hpp"
#include "export/mesh/mesh.hpp"
#include "slicing/slice_set.hpp"

namespace oval4d::exports {

/// The surface of the region around whose points the slice's faces have a winding number other than 0 (the nonzero
/// rule), meshed by marching tetrahedra. Its points lie on the faces; its edges are rounded by the width of a cube,
/// 1/128 of the slice's largest dimension. Empty if no corner of a cube is inside. `scale`: millimeters per unit of the
/// polytope.
Mesh outerSurfaceOf(const slicing::SliceSet& slices, int i, double scale, const Grid& grid, const Budget& budget);

}  // namespace oval4d::exports
