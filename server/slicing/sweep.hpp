#pragma once
// Slices a convex polytope by sweeping a hyperplane through it.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "polytopes/polytope.hpp"
#include "slicing/active_list.hpp"
#include "slicing/degeneracy_collapse.hpp"
#include "slicing/planes_below_vertices.hpp"
#include "slicing/slice_set.hpp"

namespace oval4d::slicing {

/// Slices a convex polytope with a sweep: a hyperplane w = const rises through the polytope, and active lists hold the
/// elements that the hyperplane currently cuts. Each cut edge gives a vertex of the slice, each cut 2-face an edge, and
/// each cut cell a face.
///
/// The vertex loop of a cut 2-face crosses the hyperplane on two polytope edges. On one of them, the loop rises through
/// the hyperplane; on the other, it descends. The slice edge in this 2-face runs from the first to the second. In a
/// cell, exactly two 2-faces meet at each polytope edge. So a walk along slice edges finds the boundary of the slice
/// face in the cell: where a slice edge ends, on a polytope edge, the walk goes on in the other 2-face of the cell at
/// this polytope edge.
///
/// The set of cut elements and their connections change only where the hyperplane passes a vertex. Between two
/// vertices, only the coordinates of the slice change. Reuses its memory between calls.
class HyperplaneSweep {
  public:
    /// Prepares the sweep of a polytope by `planes` hyperplanes: finds the elements that each hyperplane cuts.
    /// `planesBelow` says how many of these hyperplanes lie below each vertex; its arrays must stay valid until cut()
    /// returns. Returns false if rounding errors in the vertices make a hyperplane cut a 2-face in several segments;
    /// cut() must then not be called.
    bool begin(const polytopes::Polytope& polytope, PlanesBelowVertices planesBelow, int planes);

    /// Returns an upper bound of the total size of the slices, except those in the argument `touching` of cut(). The
    /// bound is exact if no vertex lies in a hyperplane. Slices through vertices may be smaller (see
    /// DegeneracyCollapse).
    SliceElementCounts maxSliceCounts() const { return size_; }

    /// Writes the slices to `out`. `out` must already contain the planes and the rotated vertices, and its arrays must
    /// have room for maxSliceCounts() and the slices in `touching`. The first slice becomes slice number `first` of
    /// `out`, and its elements begin at position `at`. Sets `at` to the position after the last slice.
    ///
    /// `touching` has an entry for each hyperplane. If the polytope touches the hyperplane from one side, the entry is
    /// a set that contains only the slice in this hyperplane; otherwise it is null. `touching` may be empty if all
    /// entries would be null. Returns false, and leaves `out` unusable, if rounding errors in the vertices make a
    /// hyperplane cut a cell in several polygons.
    bool cut(const polytopes::Polytope& polytope, std::span<SliceSet* const> touching, int first,
             SliceElementCounts& at, SliceSet& out);

  private:
    // The line through an edge of the polytope. At height w, the coordinates x, y, z of its point are (at.x, at.y,
    // at.z) + (w − at.w) · slope.
    struct alignas(16) EdgeLine {
        glm::dvec4 at;
        glm::dvec3 slope;
    };
    // A range of hyperplanes: those with the indices in [from, to).
    struct HyperplaneRange {
        std::int32_t from, to;
    };
    // Says where vertices lie relative to a hyperplane. `inside`: vertices lie in the hyperplane. `between`: no
    // vertices lie in it, but some lie between the next lower hyperplane and it (for the lowest hyperplane: below it).
    // `none`: there are no such vertices.
    enum class VertexEncounter : std::uint8_t { none, between, inside };
    void findStructureChanges(const polytopes::Polytope& polytope, int planes);
    bool tryFindCutElements(const polytopes::Polytope& polytope, int planes);
    void advanceTo(const polytopes::Polytope& polytope, const std::vector<glm::dvec4>& rotatedVertices, int plane);
    void beginEdge(const polytopes::Polytope& polytope, std::uint32_t edge,
                   const std::vector<glm::dvec4>& rotatedVertices);
    SliceElementCounts countsOfSlice() const {
        return {edges_.size(), faces_.size(), cells_.size(), 2 * faces_.size()};
    }
    bool writeSlices(int plane, int end, SliceElementCounts at, SliceSet& out);
    void writeVertices(int plane, int end, SliceElementCounts at, SliceSet& out);
    void writeEdges(SliceElementCounts at, SliceSet& out);
    bool writeFaces(SliceElementCounts at, SliceSet& out) const;

    PlanesBelowVertices planesBelow_;
    SliceElementCounts size_;  // the result of maxSliceCounts(): an upper bound of the total size of the slices
    int first_ = 0;            // the number that the slice in the hyperplane with the index 0 has in `out`
    ActiveElementList edges_, faces_, cells_;
    std::vector<HyperplaneRange> faceSpan_;  // per 2-face: the range of the hyperplanes that cut it
    // Per hyperplane: whether vertices lie in it, or between it and the next lower hyperplane.
    std::vector<VertexEncounter> verticesMet_;
    // The indices of the hyperplanes at which elements may become active or inactive: 0, and the indices of all other
    // hyperplanes whose entry in verticesMet_ is not `none`. The last entry is the number of hyperplanes.
    std::vector<int> structureChanges_;
    std::vector<EdgeLine> line_;            // per active edge: the straight line through it
    std::vector<std::uint32_t> vertex_;     // per active edge: the index of its slice vertex within the slice
    std::vector<std::uint32_t> sliceEdge_;  // per active 2-face: the index of its slice edge within the slice
    // The hyperplane cuts 2-face f in a segment with two ends. End 2 f lies on the polytope edge edgeOfEnd_[2 f], where
    // the vertex loop of f rises through the hyperplane. End 2 f + 1 lies on the polytope edge edgeOfEnd_[2 f + 1],
    // where the loop descends.
    //
    // The number of an end is also the number of the half-edge that runs along the segment toward this end. Half-edge 2
    // f + i belongs to the boundary loop of the section of cell faceCells[f][i]. nextEnd_[2 f + i] is the next
    // half-edge of this loop.
    std::vector<std::uint32_t> edgeOfEnd_, nextEnd_;
    // Per active cell: a half-edge on the boundary of its section (see writeFaces()).
    std::vector<std::uint32_t> firstEnd_;
    DegeneracyCollapse collapse_;
};

}  // namespace oval4d::slicing
