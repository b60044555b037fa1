#pragma once
// Classification of a polytope's cells into types, by symmetry or by shape.

#include <cstdint>
#include <string>
#include <vector>

#include "polytopes/polytope.hpp"

namespace oval4d::polytopes {

/// The maximum number of cell types. If the cells have more shapes than this, cellTypesByShape classifies them only by
/// their numbers of vertices and 2-faces. If even this gives too many types, all cells get the same type.
inline constexpr std::size_t kMaxCellTypes = 64;

/// Returns a type number for each cell; cells of the same shape have the same number. Two cells have the same shape if
/// they have equally many vertices, triangles, quadrilaterals and so on, and if each of their metric invariants agrees
/// to within 1/500 of the polytope's extent (see extentOf). The invariants are cheap to compute: the least, the
/// root-mean-square and the greatest edge length, and likewise of the distances of the vertices from their mean.
std::vector<std::uint32_t> cellTypesByShape(const Polytope& polytope);

/// Refines a classification of the cells by color refinement. `types` holds the type number of each cell. Splits a type
/// if the neighbors of its cells differ in their types, and repeats this until nothing changes. Respects
/// symmetry: if cells that are equivalent under the polytope's symmetries start with equal types, they end with equal
/// types.
std::vector<std::uint32_t> cellTypesByNeighbors(const Polytope& polytope, std::vector<std::uint32_t> types);

/// Sets polytope.typeOfCell and polytope.cellTypes. `labels` holds an arbitrary number for each cell; cells of the same
/// type have the same number. The types are numbered from the rarest to the most common; among equally common types,
/// the one with the most 2-faces per cell comes first. Each type is named after the shape of its first cell.
void numberCellTypes(Polytope& polytope, const std::vector<std::uint32_t>& labels);

/// Returns the name of a cell's shape, such as "truncated cube", "hexagonal prism" or "tetrahedron", or
/// "cell of 9 faces" if the shape has no name.
std::string nameOfCell(const Polytope& polytope, std::uint32_t cell);

}  // namespace oval4d::polytopes
