#pragma once
// Classification of a polytope's cells into types, by symmetry or by shape.

#include <cstdint>
#include <string>
#include <vector>

#include "polytopes/polytope.hpp"

namespace oval4d::polytopes {

/// The maximum number of cell types. If the cells have more shapes than this, cellTypesByShape classifies them by their
/// numbers of vertices and 2-faces alone; if there are still too many types, all cells get the same type.
inline constexpr std::size_t kMaxCellTypes = 64;

/// Returns a type number for each cell; cells of the same shape have the same number. Two cells have the same shape if
/// they have as many vertices, the same numbers of triangles, quadrilaterals and so on, and equal metric invariants, to
/// within 1/500 of the polytope's extent. The invariants are cheap to compute: the least, the root-mean-square and the
/// greatest edge length, and the same of the distances of the vertices from their mean.
std::vector<std::uint32_t> cellTypesByShape(const Polytope& polytope);

/// Refines the given types, of which there is one for each cell: splits a type if its cells have neighbors of different
/// types, and repeats this until nothing changes (color refinement). Cells that a symmetry of the polytope maps to each
/// other keep equal types if they had equal types before.
std::vector<std::uint32_t> cellTypesByNeighbors(const Polytope& polytope, std::vector<std::uint32_t> types);

/// Sets polytope.typeOfCell and polytope.cellTypes from `labels`: an arbitrary number for each cell, equal for cells of
/// the same type. The types are numbered from the rarest to the most common; among equally common types, the one with
/// the most 2-faces per cell comes first. Each type is named after the shape of its first cell.
void numberCellTypes(Polytope& polytope, const std::vector<std::uint32_t>& labels);

/// Returns the name of a cell's shape, such as "truncated cube", "hexagonal prism" or "tetrahedron", or
/// "cell of 9 faces" if the shape has no name.
std::string nameOfCell(const Polytope& polytope, std::uint32_t cell);

}  // namespace oval4d::polytopes
