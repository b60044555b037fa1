#pragma once
// The designs of uniform polychora.

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "polytopes/construction/diagram.hpp"
#include "polytopes/construction/polyhedra.hpp"
#include "polytopes/construction/recipe.hpp"

namespace oval4d::polytopes {

/// Returns the design of a diagram that parseDiagram accepts. Diagrams of the same polytope have the same design, that
/// of the largest symmetry group: x3o3o *b3o has the design of x3o3o4o.
Design designOf(const Diagram& diagram);

/// Returns the p,q-duoprism, named with the smaller number first; the 8-cell for p = q = 4. p and q are polygons of at
/// least 3 sides and may be stars.
Design duoprism(Branch p, Branch q);

/// Returns the prism over an antiprism, such as "pentagonal antiprism prism"; the octahedral prism for 3 sides.
/// `sides` must be at least 3.
Design antiprismPrism(int sides);

/// Returns the prism over a polyhedron, such as "truncated cubic prism"; the 8-cell for the cube.
Design prismOf(const NamedPolyhedron& base);

/// Returns the numbers of elements, from theory.
ElementCounts elementCounts(const Design& design);

/// Returns the order of the full symmetry group, reflections included.
std::uint64_t symmetryOrder(const Design& design);

/// Returns the diagram in linear notation, or empty if there is none.
std::string symbolOf(const Design& design);

/// Returns the Schläfli symbol, or empty if there is none.
std::string schlaefliOf(const Design& design);

/// Builds the polytope, centered at the origin; polytopes other than duals have edge length 2. Throws
/// std::invalid_argument if elements of a star diagram coincide.
Polytope build(const Design& design);

}  // namespace oval4d::polytopes
