#pragma once
// Regions of the plane, given by contours, as triangles.

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

namespace oval4d::exports {

using Contour = std::vector<glm::dvec2>;

/// The same region bounded by contours that neither cross nor touch along edges, counter-clockwise around what they
/// hold: all that the given ones wind around a number of times that is not 0.
std::vector<Contour> outlineOf(const std::vector<Contour>& contours);

/// Triangles, counter-clockwise, of the region that the contours bound; corners count through all contours in order.
/// No corner is added, none is lost: each edge of a contour is an edge of one triangle. Empty if the contours cross or
/// touch.
std::vector<std::array<std::uint32_t, 3>> triangulate(const std::vector<Contour>& contours);

}  // namespace oval4d::exports
