#pragma once
// Convex hulls of points in four dimensions.

#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec4.hpp>

#include "polytopes/polytope.hpp"

namespace oval4d::polytopes {

/// A convex hull, as computed by convexHull().
struct ConvexHull {
    std::vector<glm::dvec4> vertices;    ///< the points that are vertices of the hull, in the order of the input
    geometry::JaggedArray faces, cells;  ///< the vertex loop of each 2-face, and the 2-faces of each cell
    std::size_t ambiguousCellPairs = 0;  ///< see MergedHull::ambiguousCellPairs
    glm::dvec4 rounding{0};              ///< the parameter `rounding` of convexHull()
};

/// Computes the convex hull of points with Qhull. `rounding` is the maximum rounding error of a coordinate along each
/// axis; 0 for exact coordinates. The error bound of a point is its rounding error plus the floating-point errors and
/// the random perturbation of the computation (see HullFrame::errorBound()). Simplices whose hyperplanes agree within
/// the error bounds become one cell. A point that lies outside the hull of the other points by no more than the error
/// bounds is not a vertex of the result.
///
/// Throws a FileError if the points do not span four dimensions, if they are too imprecise, if the hull has more than
/// `maxCells` cells, or if it has more than 4 · `maxCells` simplices before merging.
ConvexHull convexHull(std::span<const glm::dvec4> points, const glm::dvec4& rounding, std::size_t maxCells);

}  // namespace oval4d::polytopes
