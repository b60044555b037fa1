#pragma once
// Computes slices in degenerate hyperplanes: those that contain vertices of the polytope.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "polytopes/polytope.hpp"
#include "slicing/coinciding_edges.hpp"
#include "slicing/planes_below_vertices.hpp"
#include "slicing/slice_set.hpp"

namespace oval4d::slicing {

/// Computes slices of a convex polytope in hyperplanes that contain vertices. Such a slice is first cut just above the
/// hyperplane, where no vertices lie. This class then moves the slice down into the hyperplane:
/// - A slice vertex that was cut from an edge with one end in the hyperplane moves to this end.
/// - A slice edge that was cut from a 2-face with an edge in the hyperplane moves to this edge.
/// - A slice face that was cut from a cell with a 2-face in the hyperplane moves to this 2-face.
/// - Slice edges that shrink to points, and slice faces that shrink to edges or points, are removed. If a removed face
///   still has two edges, these become one edge.
///
/// A vertex counts as lying in the hyperplane if it is close to the hyperplane (see kOnPlaneTolerance). A cell may be
/// inclined to the hyperplane by only a tiny angle. Then its vertices in the hyperplane need not be the vertices of a
/// single edge or 2-face. The resulting slice is closed even then.
///
/// The polytope must have vertices on both sides of the hyperplane; otherwise the slice just above the hyperplane would
/// miss elements that lie in it. Reuses its memory.
class DegeneracyCollapse {
  public:
    /// Prepares for slices of `polytope`. The arrays of `planesBelow` must stay valid until the last call of
    /// collapse().
    void begin(const polytopes::Polytope& polytope, PlanesBelowVertices planesBelow);

    /// Moves a slice from just above the hyperplane with the index `plane` down into the hyperplane, in place. The
    /// slice begins at position `at` in `out` and has the size `size`. All of its vertices must have been cut from
    /// edges, its edges from 2-faces, and its faces from cells. Returns the new size of the slice.
    SliceElementCounts collapse(const polytopes::Polytope& polytope, int plane, SliceElementCounts at,
                                SliceElementCounts size, SliceSet& out);

  private:
    static constexpr std::uint32_t kNone = 0xffffffffU;

    std::uint32_t collapseVertices(const polytopes::Polytope& polytope, SliceElementCounts at, std::uint32_t count,
                                   SliceSet& out);
    std::uint32_t collapseEdges(const polytopes::Polytope& polytope, SliceElementCounts at, std::uint32_t count,
                                SliceSet& out);
    void collapseFaces(const polytopes::Polytope& polytope, SliceElementCounts at, SliceElementCounts& size,
                       SliceSet& out);
    void removeCoincidingEdges(SliceElementCounts at, SliceElementCounts& size, SliceSet& out);
    std::uint32_t edgeInHyperplane(const polytopes::Polytope& polytope, std::uint32_t face,
                                   std::array<std::uint32_t, 2> ends) const;
    std::uint32_t faceInHyperplane(const polytopes::Polytope& polytope, std::uint32_t cell, std::size_t corners) const;

    PlanesBelowVertices planesBelow_;
    int plane_ = 0;
    // Per vertex (sliceVertex_) or edge (sliceEdge_) of the polytope: its index in the slice by the hyperplane that
    // contains it. kNone if no hyperplane contains it, or if that slice has not been collapsed yet.
    std::vector<std::uint32_t> sliceVertex_, sliceEdge_;
    // Per vertex (newVertex_) or edge (newEdge_) of the slice before the collapse: its index in the slice after the
    // collapse. kNone for an edge that was removed.
    std::vector<std::uint32_t> newVertex_, newEdge_;
    CoincidingEdges coinciding_;  // the groups of edges of the collapsed slice that coincide
};

}  // namespace oval4d::slicing
