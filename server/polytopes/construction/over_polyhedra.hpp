#pragma once

#include <optional>

#include "polytopes/construction/notation.hpp"

namespace oval4d::polytopes {

/// Parses the name of a prism, pyramid or bipyramid over a polyhedron: "prism of cube", "pyramid of rhombic
/// dodecahedron", "bipyramid of 5-gonal antiprism". solids.hpp describes the polyhedra. Returns an error if the text
/// begins with "prism of", "pyramid of" or "bipyramid of", but the rest names no convex polyhedron; std::nullopt for
/// other texts.
///
/// The prism has the height 2. If the polyhedron is uniform and its circumradius is less than 2, the height of a
/// pyramid, and of each half of a bipyramid, is such that all edges to the apex have length 2; otherwise the height is
/// the circumradius of the polyhedron. The mean of the vertices is the origin. If the name denotes a uniform polytope,
/// returns the design of this polytope: that of the 5-cell for "pyramid of tetrahedron".
std::optional<DesignOrError> overPolyhedronNamed(const NameWords& text);

}  // namespace oval4d::polytopes
