#pragma once

#include <span>
#include <string>

#include <glm/vec4.hpp>

#include "polytopes/polytope.hpp"

namespace oval4d::polytopes {

/// Returns the polytope in 4OFF (Geomview's OFF format in four dimensions), with `vertices` in place of its own.
/// Coordinates keep the polytope's units; reading the text gives the same polytope.
std::string write4Off(const Polytope& polytope, std::span<const glm::dvec4> vertices);

}  // namespace oval4d::polytopes
