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

/// Returns mirrors whose reflections generate the diagram's Coxeter group. If the diagram has the branches of a convex
/// regular polychoron, the mirrors are placed such that the polytopes with these branches have the coordinates in
/// common use (Coxeter, Regular Polytopes, §8.7, §14.9; the 5-cell as in Kageyama's paper, which README.md names).
/// Otherwise, the mirrors are computed from the Gram matrix of their normals. Throws std::invalid_argument if this
/// matrix is not positive definite; then the diagram does not describe a finite group in four dimensions.
Mirrors mirrorsOf(const Diagram& diagram);

/// Returns the point that lies at distance 1 from each ringed mirror and on all other mirrors.
glm::dvec4 generatingVertex(const Mirrors& mirrors, const std::array<bool, 4>& ringed);

/// Builds the uniform polytope of the diagram. Its vertices are the orbit of the generating vertex under the group of
/// the mirrors. Its edges, 2-faces and cells are the images, under this group, of elements at the generating vertex. A
/// set of one, two or three mirrors generates an edge, a 2-face or a cell at the generating vertex if
/// generatesElement() is true for the set. All cells of an orbit have the same cell type. If a symmetry of the diagram
/// maps an orbit to another one, the cells of both orbits have the same cell type. Throws std::invalid_argument if a
/// connected component of the diagram has no ringed mirror, if two orbits of 2-faces coincide, or if there are more
/// than `maxVertices` vertices.
Polytope wythoff(std::string name, const Diagram& diagram, const Mirrors& mirrors, std::size_t maxVertices = 100'000);

}  // namespace oval4d::polytopes
