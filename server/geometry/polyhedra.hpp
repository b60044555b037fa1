#pragma once
// Regular polygons and uniform polyhedra: their names, and what they are known by.

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "geometry/diagram.hpp"
#include "geometry/polytope.hpp"

namespace oval4d::geometry {

/// A uniform polyhedron that has a name of its own: the Platonic, Archimedean and Kepler–Poinsot solids.
struct NamedPolyhedron {
    std::string_view name;       ///< "truncated cube"
    std::string_view adjective;  ///< of its prism: "truncated cubic"
    std::string_view symbol;     ///< "x4x3o"; its nodes are s where it is snub
    std::string_view prism;      ///< Bowers' short name of its prism, or empty
};

/// All of them: Platonic, Archimedean, Kepler–Poinsot.
std::span<const NamedPolyhedron> namedPolyhedra();

/// "pentagonal", "pentagrammic", "17-gonal", "7/2-gonal".
std::string adjectiveOf(Branch polygon);

/// The polygon that a word names: "5", "5-gonal", "pentagonal", "pentagon", "5/2", "pentagrammic".
std::optional<Branch> polygonNamed(std::string_view word);

/// What a uniform polyhedron of edge length 2 is told by.
struct Shape {
    std::map<Branch, std::uint32_t> faces;  ///< how many of each polygon
    std::uint32_t vertices = 0;
    double circumradius = 0;
};

/// The name of the uniform polyhedron of this shape, its circumradius within `tolerance` of itself: "truncated cube",
/// "hexagonal prism", "pentagonal antiprism"; empty where there is none.
std::string nameOf(const Shape& shape, double tolerance);

/// A polyhedron of edge length 2 whose vertices are an orbit of a rotation group. `orbits` numbers the orbit of each
/// face.
struct SnubPolyhedron {
    std::vector<glm::dvec3> vertices;
    Lists faces;
    std::vector<std::uint32_t> orbits;
};

/// The snub of {p, q}: the snub cube of {4, 3}, the snub dodecahedron of {5, 3}, the n-antiprism of {n, 2}. Its
/// vertices are the images of one point under the rotations, its faces those about the axes of p and q and the
/// triangles between them (Coxeter, Regular Polytopes, §8.6). p and q are whole, 1/p + 1/q > 1/2.
SnubPolyhedron snubOf(Branch p, Branch q);

}  // namespace oval4d::geometry
