#pragma once
// Convex hulls of points on a grid, in exact arithmetic.

#include <vector>

#include "export/budget.hpp"
#include "export/mesh/mesh.hpp"

namespace oval4d::exports {

/// Returns the convex hull of points that lie on the grid. The computation uses integers and has no rounding errors, so
/// the mesh is always closed, 2-manifold and convex. The points must extend over at most 2^18 grid steps along each
/// axis; otherwise, the integers may overflow. Returns an empty mesh if all points lie in one plane. Takes up to
/// quadratic time in the number of points. If `budget` is not null, throws ExportRefused as
/// ExportBudget::checkTimeAndStop() does.
Mesh convexHullOfGridPoints(const std::vector<glm::dvec3>& points, const RoundingGrid& grid,
                            const ExportBudget* budget = nullptr);

}  // namespace oval4d::exports
