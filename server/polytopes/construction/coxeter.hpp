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

/// Returns mirrors whose reflections generate the diagram's Coxeter group. For the branches of a convex regular
/// polychoron (4-D polytope), the mirrors are placed such that the polytopes have the usual coordinates (Coxeter,
/// Regular Polytopes, §8.7, §14.9). Those of the 5-cell are the coordinates in Kageyama's paper, which README.md names.
/// For other branches, the mirrors are computed from the Gram matrix of their normals. Throws std::invalid_argument if
/// this matrix is not positive definite, because the diagram then describes no finite group in four dimensions.
Mirrors mirrorsOf(const CoxeterDiagram& diagram);

/// Returns the point that lies at distance 1 from each ringed mirror and on all other mirrors.
glm::dvec4 generatingVertex(const Mirrors& mirrors, const std::array<bool, 4>& ringed);

/// Builds the uniform polytope of the diagram. The vertices are the images of the generating vertex under the group
/// of the mirrors. The edges, 2-faces and cells are the images of elements at the generating vertex. A set of one,
/// two or three mirrors generates such an edge, 2-face or cell if generatesElement() is true for the set.
///
/// All cells of an orbit have the same cell type, and so have cells of two orbits that a symmetry of the diagram
/// maps to each other. Throws std::invalid_argument if a connected component of the diagram has no ringed mirror,
/// if two orbits of 2-faces coincide, or if there are more than `maxVertices` vertices.
Polytope wythoffConstruction(std::string name, const CoxeterDiagram& diagram, const Mirrors& mirrors,
                             std::size_t maxVertices = 100'000);

}  // namespace oval4d::polytopes
