#pragma once
// A spatial hash that finds coinciding points.

#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

namespace oval4d::geometry {

/// Finds equal points despite rounding errors. Points count as equal if they are less than `grid` / 4 apart, where
/// `grid` is the edge length of the cells of a spatial hash.
///
/// The hash stores only the first point of each cell. If two unequal points lie in the same cell, findOrAdd()
/// appends the second point again each time that it is added. To exclude this, points that are not equal must be
/// farther apart than 2 · `grid`, the diagonal of a cell.
class EqualPointFinder {
  public:
    explicit EqualPointFinder(double grid) : grid_(grid) {}

    /// Finds a point in `points` that equals p; appends p if there is no such point. Returns the index of the point,
    /// and true if p was appended. All calls must pass the same vector `points`.
    std::pair<std::uint32_t, bool> findOrAdd(const glm::dvec4& p, std::vector<glm::dvec4>& points) {
        for (unsigned corner = 0; corner < 16; ++corner) {
            const auto known = cells_.find(cellHash(p, corner));
            if (known != cells_.end() && glm::distance(points[known->second], p) < grid_ / 4)
                return {known->second, false};
        }
        const auto number = static_cast<std::uint32_t>(points.size());
        points.push_back(p);
        cells_.emplace(cellHash(p, 0xffU), number);
        return {number, true};
    }

  private:
    // Returns the hash of a cell: if `corner` is 0xff, of the cell that contains p. Otherwise, p is first moved by
    // grid / 4 along every axis i, in the positive direction if bit i of `corner` is set, else in the negative
    // direction; the cell is the one that contains the moved point. The cells for the values 0 … 15 of `corner` include
    // every cell that may contain a point equal to p.
    std::uint64_t cellHash(const glm::dvec4& p, unsigned corner) const {
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
    std::unordered_map<std::uint64_t, std::uint32_t> cells_;  // the hash of each cell, and the index of its first point
};

}  // namespace oval4d::geometry
