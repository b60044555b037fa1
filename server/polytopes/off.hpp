#pragma once

#include <span>
#include <string>

#include <glm/vec4.hpp>

#include "geometry/cell_complex.hpp"

namespace oval4d::polytopes {

/// Returns a polytope or another cell complex as the text of a 4OFF file (Geomview's OFF format in four dimensions).
/// The file contains `vertices`, for example rotated ones, in place of complex.vertices. `vertices` must be in the
/// order of complex.vertices. Numbers are written such that reading them gives the same doubles. importPolytope() reads
/// the file.
std::string write4Off(const geometry::CellComplex& complex, std::span<const glm::dvec4> vertices);

}  // namespace oval4d::polytopes
