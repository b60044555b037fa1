#pragma once
// Names of convex cells that are not uniform polyhedra.

#include <cstdint>
#include <string>

#include "polytopes/polytope.hpp"

namespace oval4d::polytopes {

/// Returns the name of a cell that is a pyramid, bipyramid, cuboid, other prism, antiprism or trapezohedron, such as
/// "pentagonal pyramid", or a Catalan solid, such as "rhombic dodecahedron". Returns an empty string for other cells,
/// among them tetrahedra, and for all cells if a 2-face of the polytope is not convex. Comparisons of lengths have a
/// relative tolerance of 1 %.
///
/// A cuboid must have six rectangles, and a prism must have rectangles as lateral faces. An antiprism must have regular
/// bases and equally long lateral edges. In a Catalan solid, the distances of the vertices from their mean must have
/// the same ratios as in the solid with this name. The adjective for a base of four sides is "square", "rhombic",
/// "rectangular" or "quadrilateral".
std::string nameOfIrregularCell(const Polytope& polytope, std::uint32_t cell);

}  // namespace oval4d::polytopes
