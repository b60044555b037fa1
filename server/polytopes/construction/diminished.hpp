#pragma once
// Uniform polychora without a Wythoff construction.

#include <string>

#include "polytopes/construction/recipe.hpp"
#include "polytopes/construction/snub.hpp"
#include "polytopes/polytope.hpp"

namespace oval4d::polytopes {

/// The snub 24-cell: the 600-cell diminished at the vertices of an inscribed 24-cell, with 24 icosahedra in their place
/// and the 120 remaining tetrahedra (Coxeter, Regular Polytopes, §8.5).
Design snub24Cell();

/// The grand antiprism: the 600-cell diminished at the vertices of two decagons in completely orthogonal planes, with
/// 20 pentagonal antiprisms in their place and the 300 remaining tetrahedra (Conway and Guy, 1965).
Design grandAntiprism();

/// Builds the prism over a snub polyhedron, with its height along w.
Polytope prismOver(std::string name, const SnubPolyhedron& base);

}  // namespace oval4d::polytopes
