#pragma once
// Filled bodies of slices.

#include "export/budget.hpp"
#include "export/mesh/mesh.hpp"
#include "slicing/slice_set.hpp"

namespace oval4d::exports {

/// Returns the body that the faces of slice i enclose. If the slice is convex, the body has the faces of the slice,
/// with coordinates rounded to the grid; if the rounded faces do not form a closed 2-manifold, the body is the convex
/// hull of the rounded points. If the slice is not convex, its faces may intersect; the body is then bounded by the
/// outer surface of the slice (see outer_surface.hpp). `scale` is in millimeters per unit of the polytope. Returns an
/// empty mesh if the slice has fewer than four faces or if the rounded body has no volume (see isThickEnough()). Throws
/// ExportRefused if `budget` is exceeded.
Mesh solidOf(const slicing::SliceSet& slices, int i, double scale, const RoundingGrid& grid, const Budget& budget);

}  // namespace oval4d::exports
