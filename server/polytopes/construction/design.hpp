#pragma once
// The designs of uniform polychora (4-D polytopes): how to build them, and their properties. See recipe.hpp.

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "polytopes/construction/diagram.hpp"
#include "polytopes/construction/polyhedra.hpp"
#include "polytopes/construction/recipe.hpp"

namespace oval4d::polytopes {

/// Returns the design of a diagram, which must be one that parseDiagram accepts. All diagrams of a polytope have the
/// same design, which is built from the diagram with the largest symmetry group: x3o3o *b3o has the design of x3o3o4o.
Design designOf(const Diagram& diagram);

/// Returns the design of the duoprism of the regular polygons p and q, which may be stars and must have at least 3
/// sides. The name has the smaller number first, as in "5,7-duoprism". For p = q = 4, the design is that of the 8-cell.
Design duoprism(RegularPolygon p, RegularPolygon q);

/// Returns the design of the prism over the antiprism of a regular polygon, such as "pentagonal antiprism prism".
/// `sides` is the number of sides of the polygon, at least 3. For 3 sides, the design is that of the octahedral prism.
Design antiprismPrism(int sides);

/// Returns the design of the prism over a polyhedron, such as "truncated cubic prism". For the cube, it is the design
/// of the 8-cell.
Design prismOf(const NamedPolyhedron& base);

/// Returns the numbers of elements, computed without building the polytope.
ElementCounts elementCounts(const Design& design);

/// Returns the order of the full symmetry group, which includes reflections.
std::uint64_t symmetryOrder(const Design& design);

/// Returns the diagram in linear notation, or empty if there is none.
std::string linearNotationOf(const Design& design);

/// Returns the Schläfli symbol, or empty if there is none.
std::string schlaefliOf(const Design& design);

/// Builds the polytope, centered at the origin. All edges have length 2, except in duals. Throws std::invalid_argument
/// if elements of the polytope would coincide, which happens for some star diagrams. Also throws it for a dual that
/// does not exist because a cell's hyperplane passes through the center (see dual.hpp).
Polytope build(const Design& design);

}  // namespace oval4d::polytopes
