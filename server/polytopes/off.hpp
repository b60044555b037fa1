#pragma once

#include <span>
#include <string>

#include <glm/vec4.hpp>

#include "polytopes/polytope.hpp"

namespace oval4d::polytopes {

/// Returns the polytope as the text of a 4OFF file (Geomview's OFF format in four dimensions). The file contains
/// `vertices` instead of the polytope's own vertices. Coordinates are in the polytope's units. Importing the file gives
/// the polytope with these vertices.
std::string write4Off(const Polytope& polytope, std::span<const glm::dvec4> vertices);

}  // namespace oval4d::polytopes
