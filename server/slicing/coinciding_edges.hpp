#pragma once
// Records groups of coinciding slice edges, in a union-find structure.

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace oval4d::slicing {

/// Groups of edges of a slice that coincide. When a slice is moved into a hyperplane that contains vertices (see
/// DegeneracyCollapse), a face may shrink until it has only two edges, which join the same two vertices. The slicer
/// then removes the face and replaces its two edges by one, so that the surface of the slice stays closed. Reuses its
/// memory.
class CoincidingEdges {
  public:
    /// Begins with the edges 0 … `edges` − 1. At first, no two edges coincide.
    void begin(std::uint32_t edges) {
        edges_ = edges;
        any_ = false;
    }
    /// Records that the edges `a` and `b` coincide. They may be the same edge, or may already be known to coincide.
    void markCoinciding(std::uint32_t a, std::uint32_t b) {
        if (a == b) return;  // in almost all slices, every call ends here, and first_ is never filled
        if (!any_) {
            first_.resize(edges_);
            std::iota(first_.begin(), first_.end(), 0U);
            any_ = true;
        }
        const std::uint32_t one = representativeOf(a), other = representativeOf(b);
        first_[std::max(one, other)] = std::min(one, other);
    }
    /// Returns whether any two edges coincide.
    bool anyCoincide() const { return any_; }
    /// Returns the least index in the group of edges that coincide with `edge`, including `edge` itself. Requires that
    /// anyCoincide() is true.
    std::uint32_t representativeOf(std::uint32_t edge) {
        while (first_[edge] != edge) edge = first_[edge] = first_[first_[edge]];
        return edge;
    }

  private:
    std::uint32_t edges_ = 0;
    bool any_ = false;
    // Per edge: an edge with a smaller index that coincides with this edge; if there is none, the edge itself. Valid
    // only if any_ is true.
    std::vector<std::uint32_t> first_;
};

}  // namespace oval4d::slicing
