#pragma once
// Uniform polychora from their Coxeter–Dynkin diagrams, by Wythoff's construction.

#include <array>
#include <cstddef>
#include <string>

#include "geometry/diagram.hpp"
#include "geometry/polytope.hpp"

namespace oval4d::geometry {

/// The unit normals of the diagram's mirrors. The finite groups of the regular polychora are placed so that their
/// polytopes have the coordinates in common use (Coxeter, Regular Polytopes, §8.7, §14.9; the simplex as in Kageyama's
/// paper); any other is placed by its Gram matrix. Throws std::invalid_argument if the group is not finite.
using Mirrors = std::array<glm::dvec4, 4>;
Mirrors mirrorsOf(const Diagram& diagram);

/// The point at distance 1 from the ringed mirrors and on the others.
glm::dvec4 generatingVertex(const Mirrors& mirrors, const std::array<bool, 4>& ringed);

/// The uniform polytope of the diagram: vertices are the orbit of the generating vertex, and each set of mirrors whose
/// every connected part holds a ring generates one orbit of elements. A kind of cells is such an orbit, or several that
/// a symmetry of the diagram takes to each other. Throws std::invalid_argument where the diagram makes no polytope of
/// four dimensions, or one whose 2-faces coincide, or one of more than `maxVertices` vertices.
Polytope wythoff(std::string name, const Diagram& diagram, const Mirrors& mirrors, std::size_t maxVertices = 100'000);

}  // namespace oval4d::geometry
