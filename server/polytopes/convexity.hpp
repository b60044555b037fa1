#pragma once
// A test whether a polytope is convex, so that its slices are convex too.

#include "polytopes/polytope.hpp"

namespace oval4d::polytopes {

/// Returns whether `polytope` is the boundary of a convex body. Neighboring cells may lie in the same hyperplane.
/// Returns true if four conditions hold: the boundary is connected; all 2-faces and cells are convex; the inner
/// dihedral angle at each 2-face is at most 180°; and the central projection of the cells from the mean of the vertices
/// covers the unit sphere exactly once. Takes time linear in the number of incidences: pairs of a cell and one of its
/// 2-faces, and pairs of a 2-face and one of its edges.
bool isConvex(const Polytope& polytope);

}  // namespace oval4d::polytopes
