#pragma once
// Chooses the vertices whose lines are drawn over a density strip (a plot of parallel coordinates, see
// ParallelCoordinatesLayout), and finds the line at a point of the strip. The line of a vertex joins its coordinates on
// the axes x, y, z and w.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <glm/vec2.hpp>

#include "scene/scene.hpp"

namespace oval4d::scene {

/// The maximum number of vertex lines that are drawn over a density strip. Most elements have far fewer vertices.
/// Elements of prisms of large polygons, or of loaded polytopes, can have thousands of vertices; their lines would only
/// hide the strip.
inline constexpr std::size_t kMaxLinesOverDensityStrip = 400;

/// Calls `visit(vertex)` for each vertex whose line is drawn over the density strip. `ownVertices` are the vertices of
/// the highlighted element. The lines of all of them are drawn if there are at most kMaxLinesOverDensityStrip.
/// Otherwise, this number of vertices is chosen, spread evenly over the list from its first entry to its last.
template <typename Visit>
void forEachLineOverDensityStrip(std::span<const std::uint32_t> ownVertices, Visit&& visit) {
    constexpr std::size_t kMax = kMaxLinesOverDensityStrip;
    const std::size_t count = ownVertices.size(), drawn = std::min(count, kMax);
    for (std::size_t i = 0; i < drawn; ++i) visit(ownVertices[drawn < count ? i * (count - 1) / (kMax - 1) : i]);
}

/// The greatest distance, in viewport heights, at which a point of the density strip still counts as on the line of a
/// vertex: above or below the line, or beyond its ends.
inline constexpr double kLineReach = 0.006;

/// Returns the vertex whose line passes through, or nearest to, the point `at` of a density strip. Returns an empty
/// optional if no vertex has a line within kLineReach. `at` is measured in viewport heights from the lower left corner
/// of the picture. A line that is drawn over the strip has precedence, up to ParallelCoordinatesLayout::lineWidth above
/// and below it. Otherwise, the nearest line above or below the point counts: on an axis, the line of the vertex with
/// the nearest coordinate. If several lines are equally near, for example those of vertices with equal coordinates, the
/// vertex with the lowest index counts. Requires that scene.coordinates.isDensityStrip is true. Takes time linear in
/// the number of vertices.
std::optional<std::size_t> vertexInDensityStripAt(const Scene& scene, glm::dvec2 at);

}  // namespace oval4d::scene
