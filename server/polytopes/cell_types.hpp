#pragma once
// Classification of a polytope's cells into types, by symmetry or by shape.

#include <cstdint>
#include <string>
#include <vector>

#include "polytopes/polytope.hpp"

namespace oval4d::polytopes {

/// The maximum number of types that cellTypesByShape() distinguishes. If the cells have more shapes than this,
/// cellTypesByShape() compares only their numbers of vertices and 2-faces. If more than kMaxCellTypes different pairs
/// of these two numbers occur, all cells get the same type.
inline constexpr std::size_t kMaxCellTypes = 64;

/// Returns a type number for each cell; cells of the same shape have the same number. Two cells have the same shape if
/// two conditions hold. First, the cells have equally many vertices, triangles, quadrilaterals and so on. Second, six
/// lengths agree to within 1/500 of maxDistanceFromMean(polytope): the least, the root-mean-square and the greatest
/// edge length, and the same three values of the distances of the cell's vertices from their mean.
std::vector<std::uint32_t> cellTypesByShape(const Polytope& polytope);

/// Refines a classification of the cells by color refinement, and returns the new type number of each cell. `types`
/// holds the initial type numbers. In each round, two cells of the same type get different types if the types of their
/// neighbors, listed in ascending order, differ. Neighbors are cells that share a 2-face. The rounds end when no cell
/// gets another type. If a symmetry of the polytope preserves `types`, it also preserves the result.
std::vector<std::uint32_t> cellTypesByNeighbors(const Polytope& polytope, std::vector<std::uint32_t> types);

/// Sets polytope.typeOfCell and polytope.cellTypes. `labels` holds an arbitrary number for each cell; cells of the same
/// type have the same number. The types are numbered from the rarest to the most common; among equally common types,
/// those with more 2-faces per cell come first. Each type has the name of its first cell (see nameOfCell()).
void numberCellTypes(Polytope& polytope, const std::vector<std::uint32_t>& labels);

/// Returns the name of a cell's shape, such as "truncated cube", "hexagonal prism", "square pyramid" or "rhombic
/// dodecahedron". If the shape has no name, returns a text with the number of 2-faces, such as "cell of 9 faces".
std::string nameOfCell(const Polytope& polytope, std::uint32_t cell);

}  // namespace oval4d::polytopes
