#pragma once
// Tests whether a polytope is convex. A convex polytope has convex slices.

#include "polytopes/polytope.hpp"

namespace oval4d::polytopes {

/// Returns whether `polytope` is the boundary of a convex body. Neighboring cells may lie in the same hyperplane. The
/// result is true if the boundary is connected; if all 2-faces and cells are convex; if the inner dihedral angle at
/// each 2-face is at most 180°; and if the central projection of the cells from the mean of the vertices covers the
/// unit sphere exactly once. Takes time linear in the number of incidences (pairs of a cell and a 2-face, and of a
/// 2-face and an edge).
bool isConvex(const Polytope& polytope);

}  // namespace oval4d::polytopes
