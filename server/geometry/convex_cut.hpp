#pragma once
// The usual case of a cut, made fast: a convex polytope, and no vertex in a hyperplane.

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
    /// hyperplanes under it. False, and `out` is of no use, where rounding errors in the vertices make it so that a
    /// hyperplane cuts a 2-face or a cell twice.
    bool cut(const Polytope& polytope, std::span<const std::int32_t> below, SliceSet& out);

  private:
    // Hyperplanes from … to − 1 cross the element.
    struct Span {
        std::int32_t from, to;
    };
    // The section of a 2-face: the slice vertices where its loop goes up through the hyperplane and where it comes
    // down, and the slice's own number of the edge between them.
    struct Line {
        std::array<std::uint32_t, 2> ends;
        std::uint32_t edge;
    };
    // Around a cell's section: the next slice vertex, and the edge to it.
    struct Step {
        std::uint32_t to, edge;
    };

    void cutEdges(const Polytope& polytope, std::span<const std::int32_t> below, SliceSet& out);
    bool cutFaces(const Polytope& polytope, std::span<const std::int32_t> below, SliceSet& out);
    void findEnds(const Polytope& polytope, std::span<const std::int32_t> below);
    bool cutCells(const Polytope& polytope, SliceSet& out);
    void link(const Polytope& polytope, std::uint32_t cell);

    std::vector<double> levels_;                         // w of each hyperplane
    std::vector<std::uint32_t> crossedEdges_, crossed_;  // the numbers of the elements that are cut at all
    std::vector<std::uint32_t> pointBegin_, point_;  // of edge e above its lower end: from point_[pointBegin_[e]] on
    std::vector<Span> faceSpan_, cellSpan_;
    std::vector<std::int32_t> lineBegin_;
    std::vector<Line> lines_;  // of 2-face f in hyperplane k: lines_[lineBegin_[f] + k]
    std::vector<std::uint32_t> start_, cursor_, cornerCursor_;  // by hyperplane
    std::vector<Step> steps_;                                   // by slice vertex
};

}  // namespace oval4d::geometry
