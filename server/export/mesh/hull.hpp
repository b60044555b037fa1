#pragma once
// Convex hulls of points on a grid.

#include <vector>

#include "export/mesh/mesh.hpp"

namespace oval4d::exports {

/// Returns the convex hull of points on the grid. The hull is computed with integers, without rounding errors.
/// Therefore the mesh is closed, 2-manifold and convex for all inputs. Coordinates must differ by at most 2^18 grid
/// steps. Returns an empty mesh if all points lie in one plane.
Mesh hullOf(const std::vector<glm::dvec3>& points, const Grid& grid);

}  // namespace oval4d::exports
