#pragma once

#include <span>
#include <string>

#include <glm/vec4.hpp>

#include "geometry/cell_complex.hpp"

namespace oval4d::polytopes {

/// Returns the text of a 4OFF file (Geomview's OFF format in four dimensions) with the elements of `complex`. The
/// vertices are at the positions `vertices`, for example rotated ones, in the order of complex.vertices. Each
/// number has enough digits to be read back as the same double. importPolytope() reads the file.
std::string write4Off(const geometry::CellComplex& complex, std::span<const glm::dvec4> vertices);

}  // namespace oval4d::polytopes
