#pragma once
// Names and shapes of regular polygons and uniform polyhedra.

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "polytopes/construction/diagram.hpp"
#include "polytopes/polytope.hpp"

namespace oval4d::polytopes {

/// A uniform polyhedron that has a name of its own: the Platonic, Archimedean and Kepler–Poinsot solids.
struct NamedPolyhedron {
    std::string_view name;       ///< "truncated cube"
    std::string_view adjective;  ///< used in the name of its prism: "truncated cubic"
    std::string_view symbol;     ///< its diagram, "x4x3o"; the nodes of a snub polyhedron are s
    std::string_view prism;      ///< Bowers' short name of its prism, or empty
};

/// Returns all named polyhedra: Platonic and Archimedean, then Kepler–Poinsot.
std::span<const NamedPolyhedron> namedPolyhedra();

/// Returns the adjective of a polygon: "pentagonal", "pentagrammic", "17-gonal", "7/2-gonal".
std::string adjectiveOf(Branch polygon);

/// Returns the polygon named by a word: "5", "5-gonal", "pentagonal", "pentagon", "5/2", "pentagrammic".
std::optional<Branch> polygonNamed(std::string_view word);

/// The properties by which a uniform polyhedron of edge length 2 is recognized.
struct Shape {
    std::map<Branch, std::uint32_t> faces;  ///< number of faces by polygon
    std::uint32_t vertices = 0;
    double circumradius = 0;
};

/// Returns the name of the uniform polyhedron of this shape, such as "truncated cube", "hexagonal prism" or "pentagonal
/// antiprism", or empty if there is none. `tolerance` is the relative tolerance of the circumradius.
std::string nameOf(const Shape& shape, double tolerance);

}  // namespace oval4d::polytopes
