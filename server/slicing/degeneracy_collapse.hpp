#pragma once
// Collapse of slices cut just above degenerate hyperplanes, which contain vertices of the polytope.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "polytopes/polytope.hpp"
#include "slicing/slice_set.hpp"

namespace oval4d::slicing {

/// By vertex: the number of hyperplanes strictly below it, and the number of those below or through it.
struct Levels {
    std::span<const std::int32_t> below, upTo;
    bool anyLie = false;  ///< whether any vertex lies in a hyperplane

    bool liesIn(std::uint32_t vertex, std::int32_t plane) const {
        return below[vertex] == plane && upTo[vertex] > plane;
    }
};

/// Moves slices of a convex polytope that were cut just above a hyperplane containing vertices down into the
/// hyperplane. A slice vertex cut from an edge that starts in the hyperplane moves onto the polytope vertex there; a
/// slice edge cut from a 2-face with an edge in the hyperplane moves onto that edge; a slice face cut from a cell with
/// a 2-face in the hyperplane moves onto that 2-face; and elements that shrink to nothing are removed. The polytope
/// must have vertices on both sides of the hyperplane; otherwise the slice just above would not show all that lies in
/// the hyperplane. Reuses its memory.
class DegeneracyCollapse {
  public:
    /// Prepares for a polytope. The arrays of `levels` must outlive the calls of `collapse`.
    void begin(const polytopes::Polytope& polytope, Levels levels);

    /// Collapses in place the slice of `size` at `at` in `out`, which was cut just above hyperplane `plane`: all of its
    /// vertices are cut from edges, its edges from 2-faces, and its faces from cells. Returns the new size.
    ElementCounts collapse(const polytopes::Polytope& polytope, int plane, ElementCounts at, ElementCounts size,
                           SliceSet& out);

  private:
    static constexpr std::uint32_t kNone = 0xffffffffU;

    std::uint32_t collapseVertices(const polytopes::Polytope& polytope, ElementCounts at, std::uint32_t count,
                                   SliceSet& out);
    std::uint32_t collapseEdges(const polytopes::Polytope& polytope, ElementCounts at, std::uint32_t count,
                                SliceSet& out);
    void collapseFaces(const polytopes::Polytope& polytope, ElementCounts at, ElementCounts& size, SliceSet& out) const;
    std::uint32_t baseEdge(const polytopes::Polytope& polytope, std::uint32_t face,
                           std::array<std::uint32_t, 2> ends) const;
    std::uint32_t baseFace(const polytopes::Polytope& polytope, std::uint32_t cell, std::size_t corners) const;

    Levels levels_;
    int plane_ = 0;
    // By vertex or edge of the polytope that lies in a hyperplane: its number in the slice.
    std::vector<std::uint32_t> sliceVertex_, sliceEdge_;
    // By vertex or edge of the slice before the collapse: its number afterwards.
    std::vector<std::uint32_t> newVertex_, newEdge_;
};

}  // namespace oval4d::slicing
