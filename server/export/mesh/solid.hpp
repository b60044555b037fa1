#pragma once
// Makes the filled bodies of slices.

#include "export/budget.hpp"
#include "export/mesh/mesh.hpp"
#include "slicing/slice_set.hpp"

namespace oval4d::exports {

/// Returns the body that the faces of slice i enclose. `scale` is in millimeters per unit of the polytope. The body of
/// a convex slice has the faces of the slice, with coordinates rounded to the grid. If the rounded faces are not a
/// closed 2-manifold, the body is the convex hull of the rounded points. The faces of other slices may intersect; the
/// body is then bounded by the slice's outer surface (see outer_surface.hpp). Returns an empty mesh if the slice has
/// fewer than four faces, or if the rounded body has no volume (see isThickEnough()). Throws ExportRefused if `budget`
/// is exceeded.
Mesh solidOf(const slicing::SliceSet& slices, int i, double scale, const RoundingGrid& grid,
             const ExportBudget& budget);

}  // namespace oval4d::exports
