#pragma once
// Triangulation of plane regions bounded by contours.

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

namespace oval4d::exports {

using Contour = std::vector<glm::dvec2>;

/// The boundary of the region in which the winding number of `contours` is not 0, as contours that neither cross nor
/// touch along edges and are counterclockwise around the region.
std::vector<Contour> outlineOf(const std::vector<Contour>& contours);

/// Triangulates the region bounded by the contours into counterclockwise triangles; corners are numbered consecutively
/// through all contours. No corner is added or dropped: each edge of a contour is an edge of exactly one triangle.
/// Empty if the contours cross or touch.
std::vector<std::array<std::uint32_t, 3>> triangulate(const std::vector<Contour>& contours);

}  // namespace oval4d::exports
