#pragma once
// Spatial hash for finding coinciding points.

#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

namespace oval4d::geometry {

/// A spatial hash that recognizes equal points despite rounding errors: two points that are less than `grid` / 4 apart
/// count as equal. `grid` is the edge length of the hash's grid cells. A lookup checks all grid cells that may contain
/// an equal point. The hash stores only the first point of each grid cell. Points that are not equal should therefore
/// be more than 2 · `grid`, the diagonal of a grid cell, apart; if two share a grid cell, later lookups of the second
/// do not find it.
class PointIndex {
  public:
    explicit PointIndex(double grid) : grid_(grid) {}

    /// Finds p in `points`, or appends it. Returns its index, and true if it was appended. All calls must pass the same
    /// vector `points`.
    std::pair<std::uint32_t, bool> add(const glm::dvec4& p, std::vector<glm::dvec4>& points) {
        for (unsigned corner = 0; corner < 16; ++corner) {
            const auto known = cells_.find(key(p, corner));
            if (known != cells_.end() && glm::distance(points[known->second], p) < grid_ / 4)
                return {known->second, false};
        }
        const auto number = static_cast<std::uint32_t>(points.size());
        points.push_back(p);
        cells_.emplace(key(p, 0xffU), number);
        return {number, true};
    }

  private:
    // Returns the hash of a grid cell. If corner = 0xff, this is the cell that contains p; else it is the cell that
    // contains p moved by grid / 4 along every axis, forward along axis i if bit i of `corner` is set, else backward.
    std::uint64_t key(const glm::dvec4& p, unsigned corner) const {
        std::uint64_t hash = 0;
        for (int i = 0; i < 4; ++i) {
            const double nudge = corner == 0xffU ? 0 : (corner >> static_cast<unsigned>(i) & 1U) != 0 ? 0.25 : -0.25;
            const auto cell = static_cast<std::int64_t>(std::floor(p[i] / grid_ + nudge));
            hash = (hash ^ static_cast<std::uint64_t>(cell)) * 0x9e3779b97f4a7c15ULL;
            hash ^= hash >> 29U;
        }
        return hash;
    }

    double grid_;
    std::unordered_map<std::uint64_t, std::uint32_t> cells_;  // hash of a grid cell to the index of its first point
};

}  // namespace oval4d::geometry
