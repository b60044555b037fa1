#pragma once
// The lines of single vertices in a density strip (see CoordinatesLayout). The line of a vertex joins its coordinates
// on the axes x, y, z and w.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

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

}  // namespace oval4d::scene
