#pragma once
// Merges simplices of a convex hull that lie in one hyperplane into cells.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec4.hpp>

#include "polytopes/import/hull_frame.hpp"
#include "polytopes/polytope.hpp"

namespace oval4d::polytopes {

/// A facet of a four-dimensional convex hull that has only simplices as facets: a tetrahedron.
struct SimplexFacet {
    std::array<std::uint32_t, 4> vertices;   ///< indices of points, in ascending order
    std::array<std::uint32_t, 4> neighbors;  ///< neighbor i shares the 2-face opposite vertex i
};

/// The 2-faces and cells of a convex hull after merging.
struct MergedHull {
    geometry::JaggedArray faces, cells;  ///< in the form that makePolytope expects
    /// The number of pairs of neighboring cells for which the noise leaves open whether they lie in one hyperplane.
    std::size_t ambiguousRidges = 0;
};

/// Merges neighboring simplices into one cell if their hyperplanes agree within the noise of the points, and likewise
/// merges the triangles between two cells into one 2-face. Merges fewer simplices if the cell would not be convex
/// otherwise. The resulting cells form a closed boundary, as the simplices do. `points` are in the coordinates of
/// `frame`, which also gives their noise (HullFrame::noise).
MergedHull mergeCoplanar(std::span<const SimplexFacet> simplices, std::span<const glm::dvec4> points,
                         const HullFrame& frame);

}  // namespace oval4d::polytopes
