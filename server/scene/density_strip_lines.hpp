#pragma once
// The lines of single vertices in a density strip (see CoordinatesLayout). The line of a vertex joins its coordinates
// on the axes x, y, z and w.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <glm/vec2.hpp>

#include "scene/scene.hpp"

namespace oval4d::scene {

/// The maximum number of lines that are drawn over a density strip. Most elements have far fewer vertices; those of
/// prisms of large polygons, or of loaded polytopes, can have thousands, whose lines would only hide the strip.
inline constexpr std::size_t kMaxLinesOverDensityStrip = 400;

/// Calls `visit(vertex)` for each vertex whose line is drawn over the density strip if the highlighted element has the
/// vertices `ownVertices`. These are all of them or, if they are more than kMaxLinesOverDensityStrip, this many, spread
/// evenly over the list from its first to its last.
template <typename Visit>
void forEachLineOverDensityStrip(std::span<const std::uint32_t> ownVertices, Visit&& visit) {
    constexpr std::size_t kMax = kMaxLinesOverDensityStrip;
    const std::size_t count = ownVertices.size(), drawn = std::min(count, kMax);
    for (std::size_t i = 0; i < drawn; ++i) visit(ownVertices[drawn < count ? i * (count - 1) / (kMax - 1) : i]);
}

/// The distance, in viewport heights, within which a point of the density strip is on the line of a vertex: above or
/// below the line, or beyond its ends.
inline constexpr double kLineReach = 0.006;

/// Returns the vertex to which a point of the density strip belongs; an empty optional if the line of no vertex is
/// within kLineReach. `at` is measured in viewport heights from the lower left corner of the picture. A line that is
/// drawn over the strip has precedence, up to CoordinatesLayout::lineWidth above and below it. Otherwise the vertex is
/// the one whose line is the nearest above or below the point: on an axis, the one with the nearest coordinate. Of
/// lines that are equally near, as vertices with equal coordinates have them, the one of the lowest number counts.
/// Requires CoordinatesLayout::isDensityStrip. Takes time linear in the number of vertices.
std::optional<std::size_t> vertexInDensityStripAt(const Scene& scene, glm::dvec2 at);

}  // namespace oval4d::scene
