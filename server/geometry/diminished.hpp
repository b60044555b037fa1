#pragma once
// Uniform polychora that no diagram makes.

#include <string>

#include "geometry/polyhedra.hpp"
#include "geometry/polytope.hpp"

namespace oval4d::geometry {

/// The 600-cell without the vertices of an inscribed 24-cell: 24 icosahedra in their places, and the 120 tetrahedra
/// that stay (Coxeter, Regular Polytopes, §8.5).
Polytope snub24Cell(std::string name);

/// The 600-cell without the vertices of two decagons in absolutely perpendicular planes: twenty pentagonal antiprisms
/// in their places, and the 300 tetrahedra that stay (Conway and Guy, 1965).
Polytope grandAntiprism(std::string name);

/// The prism over a snub polyhedron, along w.
Polytope prismOver(std::string name, const SnubPolyhedron& base);

}  // namespace oval4d::geometry
