#pragma once
// The usual case of a cut, made fast: a convex polytope.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/polytope.hpp"

namespace oval4d::geometry {

struct SliceSet;

/// Where an edge crosses a hyperplane there is a vertex of the slice, where a 2-face does one edge, where a cell does
/// one face: so all ranges are known from the least and greatest levels of the elements, and everything is written
/// where it stays. Keeps its scratch memory between calls.
class ConvexCut {
  public:
    /// Fills `out`, whose hyperplanes and turned vertices are there. `below` has for each vertex the number of
    /// hyperplanes strictly under it. By hyperplane, where vertices lie in it, `exact` has its slice, as a set of one;
    /// it is empty where none does. False, and `out` is of no use, where rounding errors in the vertices make it so
    /// that a hyperplane cuts a 2-face or a cell twice, or where there is too much of something.
    bool cut(const Polytope& polytope, std::span<const std::int32_t> below, std::span<SliceSet* const> exact,
             SliceSet& out);

  private:
    // What is smaller stays nearer to the processor: much of the time is waiting for memory.
    using Small = std::uint16_t;
    static constexpr std::size_t kMost = 0x7FFF;

    // Hyperplanes from … to − 1 cross the edge, which rises from its first vertex to its second or the other way.
    struct CrossedEdge {
        std::uint32_t edge : 31, rises : 1;
        Small from, to;
    };
    // Hyperplanes from … to − 1 cross the 2-face; its line in hyperplane k is lines_[at + k].
    struct FaceSpan {
        std::int32_t at;
        Small from, to;
    };
    struct CrossedCell {
        std::uint32_t cell;
        Small from, to;
    };
    // A slice vertex and a slice edge, by their numbers in their slice.
    struct Step {
        Small vertex, edge;
    };
    // The section of a 2-face: a slice edge, to where its loop goes up through the hyperplane and to where it comes
    // down.
    using Line = std::array<Step, 2>;

    void cutEdges(const Polytope& polytope, const std::int32_t* below, SliceSet& out);
    bool cutFaces(const Polytope& polytope, const std::int32_t* below, SliceSet& out);
    void findEnds(const Polytope& polytope);
    bool cutCells(const Polytope& polytope, SliceSet& out);
    void insert(std::size_t plane, const SliceSet& slice, SliceSet& out) const;
    void link(const Polytope& polytope, std::uint32_t cell);
    Step* stepsOf(std::int32_t plane) { return steps_.data() + static_cast<std::size_t>(plane) * mostVertices_; }

    // From counted differences in `begin` to where each slice's elements begin, and where they are written; a slice in
    // exact_ has count(slice).
    template <typename Count>
    void layOut(std::vector<std::uint32_t>& begin, std::vector<std::uint32_t>& place, Count count);

    std::vector<double> levels_;  // w of each hyperplane
    std::vector<CrossedEdge> crossedEdges_;
    std::vector<Small> points_;    // the slice vertices of the crossed edges, one after the other
    std::uint32_t crossings_ = 0;  // of the loops of 2-faces
    std::vector<FaceSpan> faceSpan_;
    std::vector<std::uint32_t> crossedFaces_;
    std::vector<Line> lines_;
    std::vector<CrossedCell> crossedCells_;
    std::span<SliceSet* const> exact_;
    std::vector<std::uint32_t> elsewhere_;  // elements of slices in exact_
    // By hyperplane: where the elements of its slice go, and the next one.
    std::vector<std::uint32_t> vertexPlace_, edgePlace_, facePlace_, cornerPlace_, cursor_, cornerCursor_;
    std::vector<std::uint32_t> cornerBegin_;  // by hyperplane: the corners of its slice
    std::uint32_t mostVertices_ = 0;          // of a slice
    std::vector<Step> steps_;                 // by hyperplane and vertex: how the section of the cell at hand goes on
    std::vector<Small> start_;                // by hyperplane: where it starts
};

}  // namespace oval4d::geometry
