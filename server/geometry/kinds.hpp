#pragma once
// Kinds of cells: cells that a symmetry takes to each other, or that have the same shape.

#include <cstdint>
#include <string>
#include <vector>

#include "geometry/polytope.hpp"

namespace oval4d::geometry {

/// The most kinds that a polytope has: where cells have more shapes, those with equal numbers of vertices and 2-faces
/// are one kind, and at last all.
inline constexpr std::size_t kMaxKinds = 64;

/// A number for each cell, the same for cells of the same shape: the same polygons, and as far as cheap invariants tell
/// (edge lengths, distances of vertices from their mean) congruent to within 1/500 of the circumradius.
std::vector<std::uint32_t> kindsByShape(const Polytope& polytope);

/// Tells cells of one kind apart by the kinds of their neighbours, again and again until nothing new is told. Cells
/// that a symmetry takes to each other stay of one kind.
std::vector<std::uint32_t> kindsByNeighbours(const Polytope& polytope, std::vector<std::uint32_t> kinds);

/// Sets `cellKinds` and `kinds`: numbered from the rarest on (of equals, from the one with the most faces), named by
/// the shape of the first cell.
void numberKinds(Polytope& polytope, const std::vector<std::uint32_t>& kinds);

/// "truncated cube", "hexagonal prism", "tetrahedron"; "cell of 9 faces" where the shape has no name.
std::string nameOfCell(const Polytope& polytope, std::uint32_t cell);

}  // namespace oval4d::geometry
