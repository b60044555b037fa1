#pragma once
// Sweep of a hyperplane through a convex polytope.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "polytopes/polytope.hpp"
#include "slicing/active_list.hpp"
#include "slicing/degeneracy_collapse.hpp"
#include "slicing/slice_set.hpp"
#include "slicing/vertex_ranks.hpp"

namespace oval4d::slicing {

/// Slices a convex polytope with a sweep: a hyperplane w = const rises through the polytope, and active lists hold the
/// elements that it cuts. Each cut edge gives a vertex of the slice, each cut 2-face an edge, and each cut cell a face.
/// The section of a 2-face runs from the edge where its vertex loop rises through the hyperplane to the edge where it
/// descends. The section of a cell continues, across an edge, with the next 2-face around that edge. This combinatorial
/// structure changes only when the hyperplane passes a vertex; between two vertices, only the coordinates of the slice
/// change. Reuses its scratch memory between calls.
class Sweep {
  public:
    /// Prepares the sweep of a polytope by `planes` hyperplanes: finds the elements that each hyperplane cuts. `ranks`
    /// locates the vertices relative to these hyperplanes; its arrays must outlive the call of `cut`. Returns false if
    /// rounding errors in the vertices make a hyperplane cut a 2-face or a cell twice.
    bool begin(const polytopes::Polytope& polytope, VertexRanks ranks, int planes);

    /// Returns an upper bound of the total size of the slices, without those that are passed to `cut` in `touching`.
    /// The bound is not exact if vertices lie in hyperplanes, because slices through vertices become smaller (see
    /// DegeneracyCollapse).
    SliceCounts maxSize() const { return size_; }

    /// Writes the slices to `out`. The first one becomes slice number `first` of `out`, and its elements begin at
    /// position `at`; sets `at` to the position after the last slice. `out` must contain the rotated vertices, and its
    /// arrays must be large enough. `touching` has an entry for each hyperplane. If the polytope touches the hyperplane
    /// from one side, the entry is a set that contains only the slice in this hyperplane; otherwise, the entry is null.
    /// `touching` may be empty if all entries would be null. Returns false in the same case as `begin`.
    bool cut(const polytopes::Polytope& polytope, std::span<SliceSet* const> touching, int first, SliceCounts& at,
             SliceSet& out);

  private:
    // The line through an edge: at w, its x, y and z are those of at + (w − at.w) · slope.
    struct alignas(16) Line {
        glm::dvec4 at;
        glm::dvec3 slope;
    };
    // The hyperplanes with the indices in [from, to).
    struct Span {
        std::int32_t from, to;
    };
    // Where vertices lie, as seen from a hyperplane: at least one in it (inside); none in it, but at least one between
    // it and the hyperplane below (between); or none in either place (none).
    enum class VerticesMet : std::uint8_t { none, between, inside };
    void findSteps(const polytopes::Polytope& polytope, int planes);
    bool findElements(const polytopes::Polytope& polytope, int planes);
    void advance(const polytopes::Polytope& polytope, const std::vector<glm::dvec4>& rotatedVertices, int plane);
    void beginEdge(const polytopes::Polytope& polytope, std::uint32_t edge,
                   const std::vector<glm::dvec4>& rotatedVertices);
    SliceCounts countsOfSlice() const { return {edges_.size(), faces_.size(), cells_.size(), 2 * faces_.size()}; }
    bool write(int plane, int end, SliceCounts at, SliceSet& out);
    void writeVertices(int plane, int end, SliceCounts at, SliceSet& out);
    void writeEdges(SliceCounts at, SliceSet& out);
    bool writeFaces(SliceCounts at, SliceSet& out) const;

    VertexRanks ranks_;
    SliceCounts size_;
    int first_ = 0;  // the slice number in `out` of hyperplane 0
    ActiveList edges_, faces_, cells_;
    std::vector<Span> faceSpan_;            // per 2-face
    std::vector<VerticesMet> verticesMet_;  // per hyperplane
    // The hyperplanes at which elements may become active or inactive: hyperplane 0, and all others whose
    // verticesMet_ is not `none`; then the number of hyperplanes.
    std::vector<int> steps_;
    std::vector<Line> line_;                // per active edge
    std::vector<std::uint32_t> vertex_;     // per active edge: its slice vertex
    std::vector<std::uint32_t> sliceEdge_;  // per active 2-face: its slice edge
    // The hyperplane cuts 2-face f in a segment with two ends: end 2 f lies on edge edgeOfEnd_[2 f], where the vertex
    // loop of f rises through the hyperplane, and end 2 f + 1 on edge edgeOfEnd_[2 f + 1], where the loop descends. An
    // end also stands for the directed segment (half-edge) that runs toward it: end 2 f + i belongs to the boundary
    // loop of the section of cell faceCells[f][i], and nextEnd_[2 f + i] is the next half-edge of that loop.
    std::vector<std::uint32_t> edgeOfEnd_, nextEnd_;
    std::vector<std::uint32_t> firstEnd_;  // per active cell: an end at which tracing its section starts
    DegeneracyCollapse collapse_;
};

}  // namespace oval4d::slicing
