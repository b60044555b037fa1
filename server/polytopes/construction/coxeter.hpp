#pragma once
// Wythoff's construction: uniform polychora from Coxeter–Dynkin diagrams.

#include <array>
#include <cstddef>
#include <string>

#include "polytopes/construction/diagram.hpp"
#include "polytopes/polytope.hpp"

namespace oval4d::polytopes {

/// The unit normals of four mirrors (hyperplanes through the origin).
using Mirrors = std::array<glm::dvec4, 4>;

/// Returns mirrors whose reflections generate the diagram's Coxeter group. Those of the regular polychora's groups are
/// placed such that the polytopes have the coordinates in common use (Coxeter, Regular Polytopes, §8.7, §14.9; the
/// simplex as in Kageyama's paper), those of any other group by their Gram matrix. Throws std::invalid_argument if the
/// group is not finite.
Mirrors mirrorsOf(const Diagram& diagram);

/// Returns the point that lies at distance 1 from the ringed mirrors and on the others.
glm::dvec4 generatingVertex(const Mirrors& mirrors, const std::array<bool, 4>& ringed);

/// Builds the uniform polytope of the diagram. Its vertices are the orbit of the generating vertex; each set of mirrors
/// whose connected components all contain a ringed mirror generates one orbit of elements. A cell type is such an orbit
/// of cells, or several that a symmetry of the diagram maps to each other. Throws std::invalid_argument if the polytope
/// would not be four-dimensional, would have coinciding 2-faces, or would have more than `maxVertices` vertices.
Polytope wythoff(std::string name, const Diagram& diagram, const Mirrors& mirrors, std::size_t maxVertices = 100'000);

}  // namespace oval4d::polytopes
