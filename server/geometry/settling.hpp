#pragma once
// How a slice cut just above a hyperplane comes to lie in it.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/polytope.hpp"
#include "geometry/slice_set.hpp"

namespace oval4d::geometry {

/// By vertex: the number of hyperplanes strictly below it, and of those below it or through it.
struct Levels {
    std::span<const std::int32_t> below, upTo;
    bool anyLie = false;  ///< whether any vertex lies in a hyperplane

    bool liesIn(std::uint32_t vertex, std::int32_t plane) const {
        return below[vertex] == plane && upTo[vertex] > plane;
    }
};

/// Lets the slices of a convex polytope down onto hyperplanes that vertices lie in. A point cut from an edge that
/// starts in the hyperplane falls onto that vertex, a line cut from a 2-face that stands on an edge falls onto that
/// edge, a loop around a cell that stands on a 2-face falls onto that 2-face, and what shrinks to nothing is left out.
/// The polytope must have vertices on both sides of the hyperplane, or it would touch it with more than its slice
/// shows. Keeps its memory.
class Settling {
  public:
    /// The levels must live as long as slices are settled.
    void begin(const Polytope& polytope, Levels levels);

    /// `out` has a slice of `size` at `at`, cut above hyperplane `plane`: each vertex of an edge, each edge of a
    /// 2-face, each face of a cell. It shrinks in its place. Returns its new size.
    SliceSize settle(const Polytope& polytope, int plane, SliceSize at, SliceSize size, SliceSet& out);

  private:
    static constexpr std::uint32_t kNone = 0xffffffffU;

    std::uint32_t settleVertices(const Polytope& polytope, SliceSize at, std::uint32_t count, SliceSet& out);
    std::uint32_t settleEdges(const Polytope& polytope, SliceSize at, std::uint32_t count, SliceSet& out);
    void settleFaces(const Polytope& polytope, SliceSize at, SliceSize& size, SliceSet& out) const;
    std::uint32_t edgeUnder(const Polytope& polytope, std::uint32_t face, std::array<std::uint32_t, 2> ends) const;
    std::uint32_t faceUnder(const Polytope& polytope, std::uint32_t cell, std::size_t corners) const;

    Levels levels_;
    int plane_ = 0;
    std::vector<std::uint32_t> ofVertex_,
        ofEdge_;                                // by element of the polytope in a hyperplane: its number in its slice
    std::vector<std::uint32_t> vertex_, edge_;  // by element of the slice as it was: its number now
};

}  // namespace oval4d::geometry
