#pragma once

#include <optional>

#include "polytopes/construction/notation.hpp"

namespace oval4d::polytopes {

/// Parses the name of a convex polytope whose vertices are cut off: "truncation of grand antiprism", "rectification of
/// dual of 5,7-duoprism". Returns an error if the text begins with "truncation of" or "rectification of", but the rest
/// names no polytope; std::nullopt for other texts.
///
/// The rectification is the convex hull of the midpoints of the edges. The truncation is the convex hull of the points
/// that divide the edges into thirds. If these points on the edges at a vertex do not lie in one hyperplane, several
/// cells replace the vertex. The rectification of a regular polytope has the design of the rectified uniform polytope.
/// The truncation of a regular polytope has the design of the truncated uniform polytope if the 2-faces of the regular
/// polytope are triangles; for other 2-faces, the uniform truncation does not cut the edges at their thirds.
/// Recipe::build throws std::invalid_argument if the named polytope is not convex, and TooLarge if a limit of
/// convex_hull.hpp is exceeded.
std::optional<DesignOrError> truncationOrRectificationNamed(const NameWords& text);

}  // namespace oval4d::polytopes
