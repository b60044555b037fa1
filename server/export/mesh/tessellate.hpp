#pragma once
// Outlines and triangulations of planar regions, whose boundaries are contours.

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

namespace oval4d::exports {

/// The corners of a closed polygon. The last corner is joined to the first.
using Contour = std::vector<glm::dvec2>;

/// Returns the boundary of the region in which the winding number of `contours` is not 0. The region lies to the left
/// of the returned contours: outer contours are counterclockwise, and holes clockwise. The returned contours do not
/// cross, and no two of them share an edge. Returns an empty list if the tessellator fails.
std::vector<Contour> outlineOf(const std::vector<Contour>& contours);

/// Returns counterclockwise triangles that fill the region in which the winding number of `contours` is not 0. Indices
/// count the corners of all contours, one contour after another. No corner is added or dropped: each edge of a contour
/// is an edge of exactly one triangle. Returns an empty list if the contours cross or touch, or if the tessellator
/// fails.
std::vector<std::array<std::uint32_t, 3>> triangulate(const std::vector<Contour>& contours);

}  // namespace oval4d::exports
