#pragma once
// Convex hulls of points on a grid.

#include <vector>

#include "export/budget.hpp"
#include "export/mesh/mesh.hpp"

namespace oval4d::exports {

/// Returns the convex hull of points that lie on the grid. The computation uses integers and has no rounding errors.
/// Therefore the mesh is always closed, 2-manifold and convex. The caller must ensure that the extent of the points
/// along each axis is at most 2^18 grid steps; otherwise the integers may overflow. Returns an empty mesh if all points
/// lie in one plane. Takes up to quadratic time in the number of points. `budget` may be null; otherwise, throws
/// ExportRefused as Budget::checkTimeAndStop() does.
Mesh convexHullOfGridPoints(const std::vector<glm::dvec3>& points, const RoundingGrid& grid,
                            const Budget* budget = nullptr);

}  // namespace oval4d::exports
