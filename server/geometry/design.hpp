#pragma once
// What to build, and what is known of it before it is built.

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "geometry/diagram.hpp"
#include "geometry/polyhedra.hpp"
#include "geometry/polytope.hpp"

namespace oval4d::geometry {

/// The prism over the snub of {p, q}: p = n, q = 2 is the n-antiprism's.
struct SnubPrism {
    Branch p, q;
};

/// The polychora that are cut from the 600-cell.
enum class Diminished : std::uint8_t { snub_24_cell, grand_antiprism };

using Recipe = std::variant<Diagram, SnubPrism, Diminished>;

/// A polytope by its one name, and how it is built. Texts that mean the same polytope lead to the same design.
struct Design {
    std::string name;  ///< "truncated tesseract", "5,7-duoprism"
    Recipe recipe;
};

/// The design of a diagram that is sound (as parseDiagram says). Several diagrams may have one design: that of the
/// largest symmetry group, x3o3o *b3o that of x3o3o4o.
Design designOf(const Diagram& diagram);

/// "p,q-duoprism", the smaller number first; the 8-cell for 4, 4. Each of p, q is at least {3} (or a star).
Design duoprism(Branch p, Branch q);

/// "pentagonal antiprism prism"; for 3 the octahedral prism. `sides` is at least 3.
Design antiprismPrism(int sides);

/// "truncated cubic prism"; for the cube the 8-cell.
Design prismOf(const NamedPolyhedron& base);

ElementCounts elementCounts(const Design& design);

/// Of the full symmetry group, reflections included.
std::uint64_t symmetryOrder(const Design& design);

/// In linear notation and as a Schläfli symbol; empty where there is none.
std::string symbolOf(const Design& design);
std::string schlaefliOf(const Design& design);

/// Builds it: edge length 2, centred. Throws std::invalid_argument where elements of a star diagram coincide.
Polytope build(const Design& design);

}  // namespace oval4d::geometry
