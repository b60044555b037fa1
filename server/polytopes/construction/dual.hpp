#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "polytopes/construction/notation.hpp"
#include "polytopes/construction/recipe.hpp"

namespace oval4d::polytopes {

/// Parses a text such as "dual of rectified 5-cell". Returns the design of the dual, an error if the rest of the text
/// names no polytope, or std::nullopt if the text does not begin with "dual".
///
/// The dual is the polar reciprocal of the named polytope (Coxeter, Regular Polytopes, §7.5): a vertex v of the dual
/// corresponds to the cell of the polytope in the hyperplane v · x = r², where r² is the circumradius times the least
/// distance of a cell's hyperplane from the center. So the dual has the circumradius of the polytope. For the dual of a
/// dual, the result is the design of the original polytope. If the named polytope is regular, the result is the design
/// of a regular polytope: for the 8-cell, the design of the 16-cell. If the hyperplane of a cell of the named polytope
/// passes through the center, the dual does not exist, and Recipe::build throws std::invalid_argument.
std::optional<DesignOrError> dualNamed(const NameWords& text);

}  // namespace oval4d::polytopes
