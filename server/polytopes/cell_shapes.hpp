#pragma once
// Names of convex cells that are not uniform polyhedra.

#include <cstdint>
#include <string>

#include "polytopes/polytope.hpp"

namespace oval4d::polytopes {

/// Returns the name of a cell that is a pyramid, bipyramid, prism, antiprism or trapezohedron, such as "pentagonal
/// pyramid", or a Catalan solid, such as "rhombic dodecahedron". Returns an empty string for other cells, among them
/// tetrahedra and boxes, and for all cells if a 2-face of the polytope is not convex. The lateral faces of a prism must
/// be rectangles. An antiprism must have regular bases and equally long lateral edges. A base of four sides is called
/// square, rhombic, rectangular or quadrilateral. In a Catalan solid, the distances of the vertices from the center
/// must have the correct ratios. All comparisons of lengths have a relative tolerance of 1 %.
std::string nameOfIrregularCell(const Polytope& polytope, std::uint32_t cell);

}  // namespace oval4d::polytopes
