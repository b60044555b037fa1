#pragma once
// Sorts the edges of triangles, so that triangles that share an edge are found next to each other.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace oval4d::polytopes {

using Triangle = std::array<std::uint32_t, 3>;  ///< indices of points
using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// An edge of a triangle: its ends, the smaller index first, and the index of the triangle.
struct TriangleEdge {
    Edge edge;
    std::uint32_t triangle;
};

/// Returns the edges of all triangles, sorted by their ends, then by triangle. cornersOf(t) must return the corners of
/// an element t of `triangles`.
template <typename Triangles, typename CornersOf>
std::vector<TriangleEdge> sortedTriangleEdges(const Triangles& triangles, CornersOf cornersOf) {
    std::vector<TriangleEdge> edges;
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        const Triangle& corners = cornersOf(triangles[t]);
        for (std::size_t i = 0; i < 3; ++i) edges.push_back({std::minmax(corners.at(i), corners.at((i + 1) % 3)), t});
    }
    std::sort(edges.begin(), edges.end(), [](const TriangleEdge& a, const TriangleEdge& b) {
        return std::pair(a.edge, a.triangle) < std::pair(b.edge, b.triangle);
    });
    return edges;
}

}  // namespace oval4d::polytopes
