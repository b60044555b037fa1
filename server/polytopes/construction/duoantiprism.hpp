#pragma once

#include <optional>

#include "polytopes/construction/notation.hpp"

namespace oval4d::polytopes {

/// Parses the name of a duoantiprism of two regular polygons: "3,4-duoantiprism", "3-4 duoantiprism",
/// "triangular-square duoantiprism", "pentagonal duoantiprism" (of two pentagons). Returns an error if the text ends
/// with "duoantiprism", but does not name two polygons before it, or if one of them is a star; std::nullopt for other
/// texts. The canonical name has the smaller number of sides first, as in "3,4-duoantiprism".
///
/// The duoantiprism of a p-gon and a q-gon is the convex hull of every other vertex of the duoprism of a 2p-gon and a
/// 2q-gon. Its cells are 2p q-gonal antiprisms, 2q p-gonal antiprisms and, in place of the removed vertices, 2pq
/// disphenoids. A polygon may have two sides: this digon is a single edge, and an antiprism over it is a disphenoid.
/// The design for p = q = 2 is that of the 16-cell.
///
/// The sides of all p-gons and q-gons have length 2, because with equal sides, the ratio of the longest edge to the
/// shortest one is least. The other edges, which join these polygons, are equally long; their length is greater than √2
/// and less than 2, except for p = q = 2, where it is 2.
std::optional<DesignOrError> duoantiprismNamed(const NameWords& text);

}  // namespace oval4d::polytopes
