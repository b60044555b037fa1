#pragma once
// Functions that return the designs of uniform polychora (4-D polytopes), and functions that take any design and build
// its polytope or return properties of the polytope. recipe.hpp declares Design.

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "polytopes/construction/diagram.hpp"
#include "polytopes/construction/polyhedra.hpp"
#include "polytopes/construction/recipe.hpp"

namespace oval4d::polytopes {

/// Returns the design of the polytope that `diagram` describes. The caller must ensure that parseDiagram() accepts the
/// diagram. If several diagrams describe the same polytope, the design for all of them is that of the diagram with the
/// largest group: for x3o3o *b3o, the design of x3o3o4o.
Design designOf(const Diagram& diagram);

/// Returns the design of the duoprism of the regular polygons p and q, which may be stars. The caller must ensure that
/// both have at least 3 sides. The name of the design is "p,q-duoprism", with the smaller number of sides first, as in
/// "5,7-duoprism". For p = q = 4, the design is that of the 8-cell.
Design duoprism(RegularPolygon p, RegularPolygon q);

/// Returns the design of the prism over the antiprism of a regular polygon, such as "pentagonal antiprism prism".
/// `sides` is the number of sides of the polygon, at least 3. For 3 sides, the design is that of the octahedral prism.
Design antiprismPrism(int sides);

/// Returns the design of the prism over a polyhedron, such as "truncated cubic prism". For the cube, the design is that
/// of the 8-cell.
Design prismOf(const NamedPolyhedron& base);

/// Returns the numbers of elements without building the polytope. If the polytope is constructed by a convex hull, the
/// numbers are estimates.
ElementCounts elementCounts(const Design& design);

/// Returns the order of the full symmetry group, which includes reflections; Recipe::kUnknownOrder if it is not known.
std::uint64_t symmetryOrder(const Design& design);

/// Returns the diagram in linear notation, or an empty string if there is none.
std::string linearNotationOf(const Design& design);

/// Returns the Schläfli symbol, or an empty string if there is none.
std::string schlaefliOf(const Design& design);

/// Builds the polytope, centered at the origin. In a uniform polytope, all edges have length 2. Throws
/// std::invalid_argument if elements of the polytope would coincide, which happens for some star diagrams; if a dual
/// does not exist because a cell's hyperplane passes through the center (see dual.cpp); or if a construction requires a
/// convex polytope and gets a nonconvex one. Throws TooLarge (convex_hull.hpp) if a hull exceeds its limits.
Polytope build(const Design& design);

}  // namespace oval4d::polytopes
