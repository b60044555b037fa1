#pragma once
// Parses the names of prisms and duoprisms. design.hpp declares the functions that return their designs.

#include <optional>

#include "polytopes/construction/notation.hpp"

namespace oval4d::polytopes {

/// Parses the name of a duoprism of two regular polygons: "5,7-duoprism", "5-7 duoprism", "triangular-square duoprism",
/// "pentagonal duoprism" (of two pentagons). Returns an error if the text ends with "duoprism", but does not name two
/// polygons with at least three sides before it; std::nullopt for other texts.
std::optional<DesignOrError> duoprismNamed(const NameWords& text);

/// Parses the name of a prism over a uniform polyhedron: "pentagonal antiprism prism", "6-gonal prism prism", "snub
/// cube prism", "truncated cubic prism". Returns an error for a polygon with fewer than three sides, and for a star as
/// the polygon of an antiprism; std::nullopt if the text is no such name.
std::optional<DesignOrError> prismNamed(const NameWords& text);

/// Parses the diagram of a prism over a snub polyhedron or an antiprism: "s4s3s x", "x s2s5s". Returns std::nullopt for
/// other texts.
std::optional<DesignOrError> snubPrismDiagramNamed(const NameWords& text);

}  // namespace oval4d::polytopes
