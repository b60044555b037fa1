#pragma once
// Names of convex cells that are not uniform polyhedra.

#include <cstdint>
#include <string>

#include "polytopes/polytope.hpp"

namespace oval4d::polytopes {

/// Returns the name of a cell that is a pyramid, bipyramid, cuboid, other prism, antiprism or trapezohedron, such as
/// "pentagonal pyramid", or a Catalan solid, such as "rhombic dodecahedron". Returns an empty string for other cells,
/// among them tetrahedra, and for all cells if a 2-face of the polytope is not convex. A cell counts as a cuboid only
/// if its six faces are rectangles, as a prism only if its lateral faces are rectangles, as an antiprism only if its
/// bases are regular and its lateral edges equally long, and as a Catalan solid only if the distances of its vertices
/// from their mean have the same ratios to each other as in this solid. A base of four sides is called square, rhombic,
/// rectangular or quadrilateral. All comparisons of lengths have a relative tolerance of 1 %.
std::string nameOfIrregularCell(const Polytope& polytope, std::uint32_t cell);

}  // namespace oval4d::polytopes
