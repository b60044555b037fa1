#pragma once
// The convex hull of points on the grid.

#include <vector>

#include "export/mesh.hpp"

namespace oval4d::exports {

/// Computed in integers, so that rounding decides nothing: the hull is closed, 2-manifold and convex whatever the
/// points. They must lie within 2^18 steps of the grid of each other. Empty where all lie in one plane.
Mesh hullOf(const std::vector<glm::dvec3>& points, const Grid& grid);

}  // namespace oval4d::exports
