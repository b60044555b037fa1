#pragma once
// Rounds the points of closed surfaces to a RoundingGrid.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "export/budget.hpp"
#include "export/mesh/mesh.hpp"

namespace oval4d::exports {

/// A rounded surface, the result of snapSurface().
struct SnappedSurface {
    Mesh mesh;  ///< the rounded mesh; all triangles have the cell kNoCell
    /// For each point of the mesh: the index of the input point from which it was made.
    std::vector<std::uint32_t> source;
};

/// Rounds the points of a closed surface (in millimeters) to the grid, and keeps the surface closed. The resulting mesh
/// is 2-manifold, and no two of its points are equal. The surface counts as closed if each edge of `triangles` occurs
/// equally often in both directions.
///
/// - If several fans (rings of triangles) share a point, each fan gets a point of its own.
/// - Edges whose ends become equal on the grid are collapsed, unless this would join different parts of the surface
///   (the link condition: T. Dey et al., "Topology preserving edge contraction", 1999).
/// - Triangles whose corners lie on a line are removed by flipping their longest edge, where possible.
/// - If other points become equal, all but one of them are moved to free grid points nearby.
/// - Connected parts smaller than 4 grid steps along all axes are removed.
///
/// Throws ExportRefused if the time limit is exceeded or a stop was requested. Throws std::invalid_argument if the
/// surface is not closed.
SnappedSurface snapSurface(std::span<const glm::dvec3> points, std::span<const std::array<std::uint32_t, 3>> triangles,
                           const RoundingGrid& grid, const ExportBudget& budget);

}  // namespace oval4d::exports
