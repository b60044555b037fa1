#pragma once
// Merging of a hull's coplanar simplices into cells.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec4.hpp>

#include "polytopes/import/hull_frame.hpp"
#include "polytopes/polytope.hpp"

namespace oval4d::polytopes {

/// A facet of a simplicial hull in four dimensions: a tetrahedron.
struct Simplex {
    std::array<std::uint32_t, 4> vertices;
    std::array<std::uint32_t, 4> neighbors;  ///< neighbor i shares the 2-face opposite vertex i
};

struct MergedHull {
    geometry::JaggedArray faces, cells;  ///< in the form that makePolytope expects
    std::size_t ambiguousRidges = 0;     ///< ridges whose two cells may lie in one hyperplane
};

/// Merges neighboring simplices into one cell if their hyperplanes agree within the noise of the points, and likewise
/// the triangles between two cells into one 2-face. Cells are kept convex by merging fewer simplices where necessary,
/// so the result is a closed complex, as the simplices are. `points` are given in the coordinates of `frame`, which
/// also knows their noise.
MergedHull mergeCoplanar(std::span<const Simplex> simplices, std::span<const glm::dvec4> points,
                         const HullFrame& frame);

}  // namespace oval4d::polytopes
