#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "polytopes/construction/notation.hpp"
#include "polytopes/construction/recipe.hpp"

namespace oval4d::polytopes {

/// The notation "dual of rectified 5-cell": the polar reciprocal of the named polytope (Coxeter, Regular Polytopes,
/// §7.5). A vertex v of the dual corresponds to the cell of the polytope in the hyperplane v · x = r², where r² is the
/// circumradius times the least distance of a cell from the center. So the dual is as large as the polytope, and the
/// dual of the dual is the polytope itself. The dual of a regular polytope has the design of that regular polytope.
/// Building throws std::invalid_argument if the hyperplane of a cell passes through the center.
std::optional<DesignOrError> dualNamed(const NamedText& text);

}  // namespace oval4d::polytopes
