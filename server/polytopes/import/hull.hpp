#pragma once
// Convex hulls of points in four dimensions.

#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec4.hpp>

#include "polytopes/polytope.hpp"

namespace oval4d::polytopes {

struct Hull {
    std::vector<glm::dvec4> vertices;    ///< the points that are vertices of the hull, in the order of `points`
    geometry::JaggedArray faces, cells;  ///< in the form that makePolytope expects
    std::size_t ambiguousRidges = 0;     ///< see MergedHull::ambiguousRidges
};

/// Computes the convex hull of points with Qhull. `rounding` is the maximum rounding error of a coordinate along each
/// axis; 0 for exact coordinates. Simplices whose hyperplanes agree within the rounding are merged into one cell, and a
/// point is not a vertex if it lies outside the hull of the others by no more than the rounding. Throws an ImportError
/// if the points do not span four dimensions, or if the hull has more than `maxCells` cells.
Hull convexHull(std::span<const glm::dvec4> points, const glm::dvec4& rounding, std::size_t maxCells);

}  // namespace oval4d::polytopes
