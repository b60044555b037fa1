#pragma once
// Tests whether a point lies in a convex hull.

#include <span>

#include <glm/vec4.hpp>

#include "polytopes/import/hull_frame.hpp"

namespace oval4d::polytopes {

/// Returns whether `point` lies in the convex hull of `others`, or outside it by no more than the noise: the rounding
/// errors of the point and of the hull together (see HullFrame::noise). All coordinates are those of `frame`. Finds the
/// nearest point of the hull by Wolfe's method (Finding the nearest point in a polytope, 1976). Returns false if
/// `others` is empty.
bool liesInHull(const glm::dvec4& point, std::span<const glm::dvec4> others, const HullFrame& frame);

}  // namespace oval4d::polytopes
