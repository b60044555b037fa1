#pragma once
// Prisms over polyhedra.

#include <string>

#include "polytopes/construction/snub.hpp"
#include "polytopes/polytope.hpp"

namespace oval4d::polytopes {

/// Builds the prism over a polyhedron, from w = −1 to w = 1. The two cells that are copies of the polyhedron have one
/// cell type; the other cells have one type for each orbit of faces (see PolyhedronWithFaceOrbits::orbits).
Polytope prismOver(std::string name, const PolyhedronWithFaceOrbits& base);

}  // namespace oval4d::polytopes
