#pragma once
// Uniform polychora (4-D polytopes) that Wythoff's construction does not produce.

#include "polytopes/construction/recipe.hpp"

namespace oval4d::polytopes {

/// Returns the design of the snub 24-cell: the 600-cell with the vertices of an inscribed 24-cell cut off. Its cells
/// are 24 icosahedra in place of these vertices, and the 120 remaining tetrahedra (Coxeter, Regular Polytopes, §8.5).
PolytopeDesign snub24CellDesign();

/// Returns the design of the grand antiprism: the 600-cell with the vertices of two decagons in completely orthogonal
/// planes cut off. Its cells are 20 pentagonal antiprisms in place of these vertices, and the 300 remaining tetrahedra
/// (Conway and Guy, 1965).
PolytopeDesign grandAntiprismDesign();

}  // namespace oval4d::polytopes
