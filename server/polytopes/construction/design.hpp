#pragma once
// Designs of uniform polychora (4-D polytopes). A design (recipe.hpp) has the name of a polytope, builds the polytope
// and returns its properties.

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "polytopes/construction/diagram.hpp"
#include "polytopes/construction/polyhedra.hpp"
#include "polytopes/construction/recipe.hpp"

namespace oval4d::polytopes {

/// Returns the design of the polytope that `diagram` describes. The caller must ensure that parseDiagram() accepts the
/// diagram. All diagrams of one polytope give the same design, the design of the diagram with the largest group. For
/// example, x3o3o *b3o gives the design of x3o3o4o.
PolytopeDesign designOf(const CoxeterDiagram& diagram);

/// Returns the design of the duoprism of the regular polygons p and q, which may be stars. The caller must ensure that
/// both have at least 3 sides. The name of the design is "p,q-duoprism", with the smaller number of sides first, as in
/// "5,7-duoprism". For p = q = 4, the design is that of the 8-cell.
PolytopeDesign duoprismDesign(RegularPolygon p, RegularPolygon q);

/// Returns the design of the prism over the antiprism of a regular polygon, such as "pentagonal antiprism prism".
/// `sides` is the number of sides of the polygon, at least 3. For 3 sides, the design is that of the octahedral prism.
PolytopeDesign antiprismPrismDesign(int sides);

/// Returns the design of the prism over a polyhedron, such as "truncated cubic prism". For the cube, the design is that
/// of the 8-cell.
PolytopeDesign prismDesignOver(const NamedPolyhedron& base);

/// Returns the numbers of elements of the polytope without building it. For a polytope that is built as a convex hull,
/// the numbers are estimates.
ElementCounts elementCounts(const PolytopeDesign& design);

/// Returns the order of the full symmetry group, which includes reflections, or Recipe::kUnknownOrder if the order is
/// not known.
std::uint64_t symmetryOrder(const PolytopeDesign& design);

/// Returns the Coxeter–Dynkin diagram in linear notation, such as "x3o4o3o", or an empty string if there is none.
std::string linearNotationOf(const PolytopeDesign& design);

/// Returns the Schläfli symbol, such as "{3,4,3}", or an empty string if there is none.
std::string schlaefliOf(const PolytopeDesign& design);

/// Builds the polytope, centered at the origin. In a uniform polytope, all edges have length 2. Throws
/// std::invalid_argument in three cases: elements of a star polytope would coincide; a dual does not exist, because a
/// cell's hyperplane passes through the center; or a construction requires a convex polytope and gets a nonconvex one.
/// Throws TooLarge if a convex hull exceeds the limits of convex_hull.hpp.
Polytope build(const PolytopeDesign& design);

}  // namespace oval4d::polytopes
