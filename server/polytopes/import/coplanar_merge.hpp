#pragma once
// Merges the simplices of a convex hull into cells: neighboring simplices in one hyperplane become one cell.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec4.hpp>

#include "polytopes/import/hull_frame.hpp"
#include "polytopes/polytope.hpp"

namespace oval4d::polytopes {

/// A facet (a tetrahedron) of a four-dimensional convex hull whose facets are all simplices.
struct SimplexFacet {
    std::array<std::uint32_t, 4> vertices;   ///< indices of points, in ascending order
    std::array<std::uint32_t, 4> neighbors;  ///< indices of facets; neighbor i shares the 2-face opposite vertex i
};

/// The 2-faces and cells of a convex hull after merging.
struct MergedHull {
    geometry::JaggedArray faces, cells;  ///< the vertex loop of each 2-face, and the 2-faces of each cell
    /// The number of pairs of neighboring cells for which it is uncertain whether they lie in one hyperplane. Such
    /// cells were not merged, but would be merged if the error bounds were three times as large.
    std::size_t ambiguousCellPairs = 0;
};

/// Merges neighboring simplices into one cell if their hyperplanes agree within the error bounds of the points
/// (HullFrame::errorBound()). Merges the triangles between two cells into one 2-face. If a merged cell would not be
/// convex, merges fewer simplices. The caller must ensure that `simplices` form a closed boundary; then the merged
/// cells also form a closed boundary. `points` are in the coordinates of `frame`.
MergedHull mergeCoplanar(std::span<const SimplexFacet> simplices, std::span<const glm::dvec4> points,
                         const HullFrame& frame);

}  // namespace oval4d::polytopes
