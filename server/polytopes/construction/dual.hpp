#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "polytopes/construction/notation.hpp"
#include "polytopes/construction/recipe.hpp"

namespace oval4d::polytopes {

/// Parses the notation "dual of rectified 5-cell". Returns the design of the dual, an error if the rest of the text
/// names no polytope, or std::nullopt if the text does not begin with "dual".
///
/// The dual is the polar reciprocal of the named polytope (Coxeter, Regular Polytopes, §7.5): a vertex v of the dual
/// corresponds to the cell of the polytope in the hyperplane v · x = r², where r² is the circumradius times the least
/// distance of a cell's hyperplane from the center. So the dual has the circumradius of the polytope. The dual of the
/// dual has the design of the polytope itself. The dual of a regular polytope has the design of a regular polytope:
/// that of the 8-cell is the 16-cell. Recipe::build throws std::invalid_argument if the hyperplane of a cell passes
/// through the center.
std::optional<DesignOrError> dualNamed(const NameWords& text);

}  // namespace oval4d::polytopes
