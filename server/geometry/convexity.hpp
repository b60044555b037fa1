#pragma once
// Whether a polytope is convex: whether its slices are, then.

#include "geometry/polytope.hpp"

namespace oval4d::geometry {

/// True where `polytope` is the boundary of a convex body. Takes time in proportion to the incidences: seen from the
/// middle of the vertices, the cells must cover the sphere of directions once and bend inward at every 2-face. Cells
/// in one hyperplane count as bending.
bool isConvex(const Polytope& polytope);

}  // namespace oval4d::geometry
