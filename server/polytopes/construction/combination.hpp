#pragma once

#include <optional>

#include "polytopes/construction/notation.hpp"

namespace oval4d::polytopes {

/// Parses the name of a combination of two polytopes: "hull of tesseract and 16-cell", "intersection of 120-cell and
/// 600-cell of circumradius 4", "product of 5-gon and 7-gon". Returns an error if the text begins with "hull of",
/// "intersection of" or "product of" but is not a valid name; std::nullopt for other texts.
///
/// Both polytopes of a hull or an intersection must be convex; each is centered at the origin. By default, the first
/// polytope has the size with which it is built alone, and the second polytope is scaled to the circumradius of the
/// first. "of circumradius" and a number from 0.01 to 100 after a name scale this polytope to the given circumradius.
/// The result is moved such that the mean of its vertices is the origin. Recipe::build throws std::invalid_argument if
/// one of the two polytopes is not convex, and TooLarge if a limit of convex_hull.hpp is exceeded.
///
/// The product of two polygons is their duoprism; the product of a polyhedron and a segment (of length 2) is the prism
/// over the polyhedron.
std::optional<DesignOrError> combinationNamed(const NameWords& text);

}  // namespace oval4d::polytopes
