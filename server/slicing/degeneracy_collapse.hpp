#pragma once
// Slices in degenerate hyperplanes, which contain vertices of the polytope.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "polytopes/polytope.hpp"
#include "slicing/slice_set.hpp"

namespace oval4d::slicing {

/// The positions of a polytope's vertices relative to the hyperplanes. below[v] is the number of hyperplanes strictly
/// below vertex v; upTo[v] is the number of hyperplanes below or through v. If upTo[v] > below[v], v lies in the
/// hyperplane with the index below[v].
struct VertexLevels {
    std::span<const std::int32_t> below, upTo;
    bool anyOnPlane = false;  ///< whether any vertex lies in a hyperplane

    /// Returns whether the vertex lies in the hyperplane with the index `plane`.
    bool liesIn(std::uint32_t vertex, std::int32_t plane) const {
        return below[vertex] == plane && upTo[vertex] > plane;
    }
};

/// Computes slices of a convex polytope in hyperplanes that contain vertices. Such a slice is first cut just above the
/// hyperplane, where no vertices lie; this class then moves it down into the hyperplane. A slice vertex cut from an
/// edge that starts in the hyperplane moves onto the polytope vertex there; a slice edge cut from a 2-face with an edge
/// in the hyperplane moves onto that edge; a slice face cut from a cell with a 2-face in the hyperplane moves onto that
/// 2-face. Slice edges that shrink to points, and slice faces that shrink to edges or points, are removed. The polytope
/// must have vertices on both sides of the hyperplane; otherwise the slice just above it would miss elements that lie
/// in the hyperplane. Reuses its memory.
class DegeneracyCollapse {
  public:
    /// Prepares for slices of this polytope. The arrays of `levels` must outlive the calls of `collapse`.
    void begin(const polytopes::Polytope& polytope, VertexLevels levels);

    /// Collapses, in place, the slice that begins at position `at` in `out` and has this `size`. It was cut just above
    /// the hyperplane with the index `plane`: all of its vertices were cut from edges, its edges from 2-faces, and its
    /// faces from cells. Returns its new size.
    SliceCounts collapse(const polytopes::Polytope& polytope, int plane, SliceCounts at, SliceCounts size,
                         SliceSet& out);

  private:
    static constexpr std::uint32_t kNone = 0xffffffffU;

    std::uint32_t collapseVertices(const polytopes::Polytope& polytope, SliceCounts at, std::uint32_t count,
                                   SliceSet& out);
    std::uint32_t collapseEdges(const polytopes::Polytope& polytope, SliceCounts at, std::uint32_t count,
                                SliceSet& out);
    void collapseFaces(const polytopes::Polytope& polytope, SliceCounts at, SliceCounts& size, SliceSet& out) const;
    std::uint32_t baseEdge(const polytopes::Polytope& polytope, std::uint32_t face,
                           std::array<std::uint32_t, 2> ends) const;
    std::uint32_t baseFace(const polytopes::Polytope& polytope, std::uint32_t cell, std::size_t corners) const;

    VertexLevels levels_;
    int plane_ = 0;
    // By vertex or edge of the polytope: its index in the slice if it lies in the hyperplane; kNone: not found yet.
    std::vector<std::uint32_t> sliceVertex_, sliceEdge_;
    // By vertex or edge of the slice before the collapse: its index afterward; kNone for an edge that was removed.
    std::vector<std::uint32_t> newVertex_, newEdge_;
};

}  // namespace oval4d::slicing
