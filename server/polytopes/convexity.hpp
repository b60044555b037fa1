#pragma once
// The convexity test. A convex polytope has convex slices.

#include "polytopes/polytope.hpp"

namespace oval4d::polytopes {

/// Returns whether `polytope` is the boundary of a convex body. Takes time linear in the number of incidences. The
/// criterion: seen from the mean of the vertices, the cells cover the sphere of directions exactly once, and no 2-face
/// is reentrant. Neighboring cells may lie in one hyperplane.
bool isConvex(const Polytope& polytope);

}  // namespace oval4d::polytopes
