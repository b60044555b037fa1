#pragma once
// A union-find structure of edges that coincide.

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace oval4d::slicing {

/// Edges of a slice that coincide. If a face of the slice shrinks until only two of its edges are left, these edges
/// join the same two vertices. The face is removed, and the two edges become one, so that the surface stays closed.
/// Reuses its memory.
class CoincidingEdges {
  public:
    /// Begins with edges 0 … edges − 1, all of which are different.
    void begin(std::uint32_t edges) {
        edges_ = edges;
        any_ = false;
    }
    /// Makes two edges one edge. They may already be the same edge.
    void join(std::uint32_t a, std::uint32_t b) {
        if (a == b) return;  // in almost all slices, this is true of all calls, and the list is not even made
        if (!any_) {
            first_.resize(edges_);
            std::iota(first_.begin(), first_.end(), 0U);
            any_ = true;
        }
        const std::uint32_t one = firstOf(a), other = firstOf(b);
        first_[std::max(one, other)] = std::min(one, other);
    }
    /// Returns whether any edges coincide.
    bool any() const { return any_; }
    /// Returns the edge with the least index that coincides with this one. Requires any().
    std::uint32_t firstOf(std::uint32_t edge) {
        while (first_[edge] != edge) edge = first_[edge] = first_[first_[edge]];
        return edge;
    }

  private:
    std::uint32_t edges_ = 0;
    bool any_ = false;
    // Valid only if any_. Per edge: an edge with a smaller index that coincides with it, or else the edge itself.
    std::vector<std::uint32_t> first_;
};

}  // namespace oval4d::slicing
