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

/// A uniform polyhedron with a name of its own: a Platonic, Archimedean or Kepler–Poinsot solid.
struct NamedPolyhedron {
    std::string_view name;            ///< the name of the polyhedron, such as "truncated cube"
    std::string_view adjective;       ///< the adjective in the name of the prism over the polyhedron, such as
                                      ///< "truncated cubic"
    std::string_view linearNotation;  ///< the diagram of the polyhedron, such as "x4x3o", or "s4s3s" for a snub
                                      ///< polyhedron
    std::string_view prism;  ///< Bowers' short name of the prism; empty if the catalogue does not contain the prism
};

/// Returns all named polyhedra: the Platonic and Archimedean solids, then the Kepler–Poinsot solids.
std::span<const NamedPolyhedron> namedPolyhedra();

/// Returns whether the polyhedron is convex. Only the Kepler–Poinsot solids are not.
bool isConvex(const NamedPolyhedron& polyhedron);

/// Returns the vertices of the polyhedron, scaled to edge length 2 and centered at the origin.
std::vector<glm::dvec3> verticesOf(const NamedPolyhedron& polyhedron);

/// Returns the adjective of a polygon: "pentagonal", "pentagrammic", "17-gonal", "7/2-gonal".
std::string adjectiveOf(RegularPolygon polygon);

/// Returns the noun of a polygon: "pentagon", "pentagram", "17-gon", "7/2-gon".
std::string polygonNoun(RegularPolygon polygon);

/// Returns the polygon that a word names, such as "5", "5-gonal", "pentagonal", "pentagon", "5/2" or "pentagrammic".
/// Returns an empty optional if the word names no polygon. "2" gives a polygon of two sides; callers that need at least
/// three sides must reject it.
std::optional<RegularPolygon> polygonNamed(std::string_view word);

/// Returns the polygons that `words`, the words before "duoprism" or "duoantiprism" in a name, denote. Returns two
/// polygons for "5,7", "5x7", "5" "7" or "triangular" "square". If the words name one polygon, such as "pentagonal",
/// returns this polygon twice. Returns an empty optional if a word names no polygon. Callers must reject a result that
/// does not have exactly two polygons; callers that need at least three sides must reject polygons of two sides.
std::optional<std::vector<RegularPolygon>> duoprismPolygonsNamed(std::vector<std::string> words);

/// The properties by which nameOf() identifies a uniform polyhedron.
struct PolyhedronSignature {
    std::map<RegularPolygon, std::uint32_t> faces;  ///< for each kind of polygon, the number of faces
    std::uint32_t vertices = 0;                     ///< the number of vertices
    double circumradius = 0;                        ///< the circumradius if the edges have length 2
};

/// Returns the name of the uniform polyhedron with these properties, such as "truncated cube", "hexagonal prism" or
/// "pentagonal antiprism". Returns an empty text if there is none. The circumradius may have a relative error of up to
/// `tolerance`.
std::string nameOf(const PolyhedronSignature& shape, double tolerance);

}  // namespace oval4d::polytopes
