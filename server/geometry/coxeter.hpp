#pragma once
// Uniform polychora from their Coxeter–Dynkin diagrams, by Wythoff's construction.

#include <array>
#include <cstdint>
#include <string>

#include "geometry/polytope.hpp"

namespace oval4d::geometry {

/// A branch of a diagram: the mirrors at its two ends meet at π·denominator / numerator.
struct Branch {
    int numerator = 2, denominator = 1;
    bool operator==(const Branch&) const = default;
};

/// Four mirrors and which of them are ringed: the generating vertex stands off the ringed mirrors at distance 1, so
/// that all edges are 2 long, and lies on the others.
struct Diagram {
    std::array<std::array<Branch, 4>, 4> branches;  ///< symmetric; the diagonal is not read
    std::array<bool, 4> ringed{};

    /// The linear diagram with these three branches: {p, q, r}.
    static Diagram linear(Branch p, Branch q, Branch r, std::array<bool, 4> ringed);
};

/// The unit normals of the diagram's mirrors. The finite groups of the regular polychora are placed so that their
/// polytopes have the coordinates in common use (Coxeter, Regular Polytopes, §8.7, §14.9; the simplex as in Kageyama's
/// paper); any other is placed by its Gram matrix. Throws std::invalid_argument if the group is not finite.
using Mirrors = std::array<glm::dvec4, 4>;
Mirrors mirrorsOf(const Diagram& diagram);

/// The uniform polytope of the diagram: vertices are the orbit of the generating vertex, and each set of mirrors whose
/// every connected part holds a ring generates one orbit of elements. Throws std::invalid_argument where the diagram
/// makes no polytope of four dimensions, or one of more than `maxVertices` vertices.
Polytope wythoff(std::string name, const Diagram& diagram, const Mirrors& mirrors, std::size_t maxVertices = 100'000);

}  // namespace oval4d::geometry
