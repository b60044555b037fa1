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

namespace oval4d::slicing {

/// Slices a convex polytope with a sweep: a hyperplane w = const rises through the polytope, and active lists hold the
/// elements that it cuts. Each cut edge gives a vertex of the slice, each cut 2-face an edge, and each cut cell a face.
/// The section of a 2-face runs from the edge where its vertex loop rises through the hyperplane to the edge where it
/// descends. The section of a cell continues, across an edge, with the next 2-face around that edge. This combinatorial
/// structure changes only when the hyperplane passes a vertex; between two vertices, only the coordinates of the slice
/// change. Reuses its scratch memory between calls.
class Sweep {
  public:
    /// Prepares the sweep of a polytope by `planes` hyperplanes: finds the elements that each of them cuts. `levels`
    /// describes only these hyperplanes; its arrays must outlive the call of `cut`. Returns false if rounding errors in
    /// the vertices make a hyperplane cut a 2-face or a cell twice.
    bool begin(const polytopes::Polytope& polytope, VertexLevels levels, int planes);

    /// Returns an upper bound of the total size of the slices, without those that are passed to `cut` in `touching`. It
    /// is not exact if vertices lie in hyperplanes, because the slices there become smaller (see DegeneracyCollapse).
    SliceCounts size() const { return size_; }

    /// Writes the slices to `out`. The first one becomes slice number `first` of `out`, and its elements begin at
    /// position `at`; sets `at` to the position after the last slice. `out` must contain the rotated vertices, and its
    /// arrays must be large enough. `touching` has an entry for each hyperplane: a set with only the slice there if the
    /// polytope touches the hyperplane from one side, else null. It may be empty if all entries would be null. Returns
    /// false in the same case as `begin`.
    bool cut(const polytopes::Polytope& polytope, std::span<SliceSet* const> touching, int first, SliceCounts& at,
             SliceSet& out);

  private:
    // The line through an edge; its point with the w coordinate w is at + (w − at.w) · slope.
    struct alignas(16) Line {
        glm::dvec4 at;
        glm::dvec3 slope;
    };
    struct Span {
        std::int32_t from, to;
    };
    // Where vertices lie: in a hyperplane (inside), only between it and the hyperplane below (between), or in neither
    // place.
    enum class VertexPosition : std::uint8_t { none, between, inside };
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

    VertexLevels levels_;
    SliceCounts size_;
    int first_ = 0;
    ActiveList edges_, faces_, cells_;
    std::vector<Span> faceSpan_;
    std::vector<VertexPosition> vertexPosition_;  // by hyperplane
    std::vector<int> steps_;                // hyperplane 0, the others with a vertexPosition_, and the end of the range
    std::vector<Line> line_;                // by active edge
    std::vector<std::uint32_t> vertex_;     // by active edge: its slice vertex
    std::vector<std::uint32_t> sliceEdge_;  // by active 2-face: its slice edge
    // The section of 2-face f has two ends, numbered 2 f and 2 f + 1: the 2-face's vertex loop rises through the
    // hyperplane at edge end_[2 f] and descends at edge end_[2 f + 1]. In cell faceCells[f][i], the cell's section
    // traverses 2-face f toward the end 2 f + i, and then the next 2-face toward the end next_[2 f + i].
    std::vector<std::uint32_t> end_, next_;
    std::vector<std::uint32_t> startEnd_;  // by active cell: an end at which tracing its section starts
    DegeneracyCollapse collapse_;
};

}  // namespace oval4d::slicing
