#pragma once
// Convex polyhedra as bases of 4-D polytopes: Platonic and Archimedean solids, prisms, antiprisms, and their duals.

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <glm/vec3.hpp>

#include "geometry/jagged_array.hpp"
#include "polytopes/construction/diagram_text.hpp"
#include "polytopes/construction/polyhedra.hpp"
#include "polytopes/construction/recipe.hpp"

namespace oval4d::polytopes {

/// The numbers of elements of a polyhedron.
struct SolidCounts {
    std::uint64_t vertices = 0, edges = 0, faces = 0;
};

/// A convex uniform polyhedron of edge length 2 or, if `dual` is set, the dual of such a polyhedron, with the same
/// circumradius.
struct SolidDescription {
    const NamedPolyhedron* named = nullptr;  ///< a Platonic or Archimedean solid; null for a prism or antiprism
    int sides = 0;                           ///< the number of sides of the base of a prism or antiprism; else 0
    bool antiprism = false;
    bool dual = false;

    bool operator==(const SolidDescription&) const = default;
};

/// Returns the solid that the words name, such as "truncated cube", "5 gonal prism", "pentagonal antiprism", "dual of
/// cuboctahedron", "rhombic dodecahedron" or "hexagonal bipyramid". There must be at least one word; all words must be
/// in lower case. Returns an error if the words name a star, or a solid over a polygon of fewer than three sides.
/// Returns an empty optional if the words name no polyhedron. All names of a solid give equal values: "dual of cube"
/// gives the value of "octahedron".
std::optional<std::variant<SolidDescription, PolytopeNameError>> solidNamed(const std::vector<std::string>& words);

/// Returns the name of the solid, such as "truncated cube", "pentagonal prism" or "rhombic dodecahedron".
std::string nameOf(const SolidDescription& solid);

SolidCounts countsOf(const SolidDescription& solid);

/// The vertices and faces of a polyhedron.
struct SolidMesh {
    std::vector<glm::dvec3> vertices;  ///< the positions relative to the center
    geometry::JaggedArray faces;       ///< the vertex loop of each face; the directions of the loops are arbitrary
};

/// Builds the mesh of a solid, with the edge length or circumradius that the comment of SolidDescription states.
SolidMesh meshOf(const SolidDescription& solid);

/// Returns the design of the uniform prism over a solid. The caller must ensure that `solid` is not a dual.
PolytopeDesign uniformPrismOver(const SolidDescription& solid);

}  // namespace oval4d::polytopes
