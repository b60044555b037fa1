#pragma once
// A test whether a point lies in a convex hull.

#include <span>

#include <glm/vec4.hpp>

#include "polytopes/import/hull_frame.hpp"

namespace oval4d::polytopes {

/// Returns whether `point` lies in the convex hull of `others`, or outside by no more than the errors of the points
/// allow: by at most 2 · HullFrame::errorBound(), once for the error of `point` and once for the error of the hull.
/// `point` and `others` are in the coordinates of `frame`. Finds the nearest point of the hull by Wolfe's method
/// (Finding the nearest point in a polytope, 1976). Returns false if `others` is empty, or if rounding errors prevent
/// convergence.
bool liesInHull(const glm::dvec4& point, std::span<const glm::dvec4> others, const HullFrame& frame);

}  // namespace oval4d::polytopes
