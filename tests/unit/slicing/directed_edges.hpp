#pragma once
// Checks of triangle meshes that do not use the code under test.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace oval4d::support {

/// The directed edges of a triangle mesh: each triangle has three of them.
class DirectedEdges {
  public:
    explicit DirectedEdges(std::span<const std::array<std::uint32_t, 3>> triangles) {
        edges_.reserve(3 * triangles.size());
        for (const auto& t : triangles) {
            for (std::size_t i = 0; i < 3; ++i) edges_.push_back({t[i], t[(i + 1) % 3], t[(i + 2) % 3]});
        }
        std::ranges::sort(edges_);
    }

    /// Returns the number of different directed edges.
    std::size_t different() const {
        std::size_t number = 0;
        forEachDifferent([&](const Edge&, std::size_t) { ++number; });
        return number;
    }
    /// Returns how many directed edges occur more than once, or have an opposite edge that does not occur exactly once.
    /// In a closed mesh, there are none.
    std::size_t unpaired() const {
        std::size_t number = 0;
        forEachDifferent([&](const Edge& edge, std::size_t times) {
            number += times != 1 || from(edge[1], edge[0]).size() != 1 ? 1U : 0U;
        });
        return number;
    }
    /// Returns how many directed edges occur more often than their opposite edges. In a closed mesh, there are none.
    std::size_t unbalanced() const {
        std::size_t number = 0;
        forEachDifferent(
            [&](const Edge& edge, std::size_t times) { number += times > from(edge[1], edge[0]).size() ? 1U : 0U; });
        return number;
    }
    /// Returns whether the mesh is closed, and the triangles around each of its points form one ring.
    bool isManifold() const {
        for (auto first = edges_.begin(); first != edges_.end();) {
            const auto last =
                std::ranges::find_if(first, edges_.end(), [&](const Edge& e) { return e[0] != (*first)[0]; });
            auto at = first;
            for (auto steps = last - first; steps > 0; --steps) {
                const auto next = from((*at)[0], (*at)[2]);
                if (next.size() != 1) return false;
                at = first + (next.data() - &*first);
                if ((at == first) != (steps == 1)) return false;
            }
            first = last;
        }
        return true;
    }

  private:
    using Edge = std::array<std::uint32_t, 3>;  // the start, the end, and the third corner of the triangle

    std::span<const Edge> from(std::uint32_t start, std::uint32_t end) const {
        return std::ranges::equal_range(edges_, Edge{start, end}, {}, [](const Edge& e) { return Edge{e[0], e[1]}; });
    }
    template <typename Visit>
    void forEachDifferent(Visit&& visit) const {
        for (std::size_t i = 0; i < edges_.size();) {
            const std::size_t times = from(edges_[i][0], edges_[i][1]).size();
            visit(edges_[i], times);
            i += times;
        }
    }

    std::vector<Edge> edges_;  // the directed edges in ascending order
};

}  // namespace oval4d::support
