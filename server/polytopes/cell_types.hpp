#pragma once
// Classification of a polytope's cells into types, by symmetry or by shape.

#include <cstdint>
#include <string>
#include <vector>

#include "polytopes/polytope.hpp"

namespace oval4d::polytopes {

/// The maximum number of cell types. Cells of more shapes than this are classified by their numbers of vertices and
/// 2-faces alone; if that still gives more types, all cells are of one type.
inline constexpr std::size_t kMaxCellTypes = 64;

/// Returns a type number for each cell, equal for cells of the same shape. Two cells have the same shape if they have
/// the same polygons and the same cheap metric invariants to within 1/500 of the polytope's extent: the least, the
/// root-mean-square and the greatest edge length, and likewise for the distances of the vertices from their mean.
std::vector<std::uint32_t> cellTypesByShape(const Polytope& polytope);

/// Refines the given types: repeatedly splits types whose cells have neighbors of different types, until nothing
/// changes (color refinement). Cells that a symmetry maps to each other keep the same type.
std::vector<std::uint32_t> cellTypesByNeighbors(const Polytope& polytope, std::vector<std::uint32_t> types);

/// Sets `typeOfCell` and `cellTypes` from arbitrary type labels, one for each cell. Types are numbered from the rarest
/// to the most common (among equally common ones, the type with the most 2-faces per cell first) and named after the
/// shape of their first cell.
void numberCellTypes(Polytope& polytope, const std::vector<std::uint32_t>& labels);

/// Returns the name of a cell's shape, such as "truncated cube", "hexagonal prism" or "tetrahedron", or
/// "cell of 9 faces" if the shape has no name.
std::string nameOfCell(const Polytope& polytope, std::uint32_t cell);

}  // namespace oval4d::polytopes
