#pragma once

#include <span>
#include <string>

#include <glm/vec4.hpp>

#include "polytopes/polytope.hpp"

namespace oval4d::polytopes {

/// Returns the text of a 4OFF file (Geomview's OFF format in four dimensions) with the polytope, but with `vertices` in
/// place of its own. Coordinates are in the polytope's units. Reading the file gives the same polytope.
std::string write4Off(const Polytope& polytope, std::span<const glm::dvec4> vertices);

}  // namespace oval4d::polytopes
