#pragma once
// Cuts a polytope by parallel hyperplanes w = const.

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "geometry/convex_cut.hpp"
#include "geometry/polytope.hpp"
#include "geometry/rotation.hpp"
#include "geometry/slice_set.hpp"

namespace oval4d::geometry {

/// Cuts polytopes; keeps its scratch memory between calls, so that a steady stream of slices allocates nothing.
/// One slicer serves one thread at a time.
class Slicer {
  public:
    /// A vertex within this fraction of the circumradius of a hyperplane lies in it.
    static constexpr double kOnPlane = 1e-9;

    /// Turns `polytope` and cuts it. `out` is overwritten and its memory reused.
    void slice(const Polytope& polytope, const Rotation& orientation, const Hyperplanes& planes, SliceSet& out);

  private:
    static constexpr std::int32_t kNoPlane = -1;
    static constexpr std::uint32_t kNone = 0xffffffffU;
    static constexpr std::uint32_t kFresh = 0xfffffffeU;

    // Hyperplanes from … to − 1; none where to ≤ from.
    struct Span {
        std::int32_t from, to;
    };
    // A piece of a 2-face's section just above hyperplane `plane`, from where the loop goes up through it to where it
    // comes down. `edge` is its slice edge, or kNone where it shrinks to a point in the hyperplane itself; until slice
    // edges are numbered, kFresh, or the 4-D edge in the hyperplane that it falls onto.
    struct Line {
        std::int32_t plane;
        std::uint32_t up, down;  // slots
        std::uint32_t edge;
    };
    // A closed loop of a cell's section, its corners in loopCorners_.
    struct Loop {
        std::int32_t plane;
        std::uint32_t of, begin, size;
    };
    struct Crossing {
        std::uint32_t slot;
        double along;
    };

    // Turns the vertices and counts the hyperplanes under each.
    void locateVertices(const Polytope& polytope, const Rotation& orientation, SliceSet& out);
    void cutAny(const Polytope& polytope, SliceSet& out);
    bool cutConvex(const Polytope& polytope, SliceSet& out);
    bool cutTouching(const Polytope& polytope, SliceSet& out);
    void cutOne(const Polytope& polytope, std::int32_t plane, SliceSet& single, SliceSet& all);
    void cutEdges(const Polytope& polytope, SliceSet& out);
    void cutFaces(const Polytope& polytope, SliceSet& out);
    void cutConvexFace(const Polytope& polytope, std::uint32_t face, Span above);
    void cutAnyFace(const Polytope& polytope, std::uint32_t face, Span above, const SliceSet& out);
    void addLine(const Polytope& polytope, std::uint32_t face, std::int32_t plane, std::uint32_t up,
                 std::uint32_t down);
    void numberEdges(const Polytope& polytope, SliceSet& out);
    bool liesInOne(const std::array<std::uint32_t, 2>& edge) const {
        return below_[edge[0]] == below_[edge[1]] && below_[edge[0]] < upTo_[edge[0]] &&
               below_[edge[1]] < upTo_[edge[1]];
    }
    void cutCells(const Polytope& polytope, SliceSet& out);
    void addLyingFaces(const Polytope& polytope, const SliceSet& out);
    void addLyingFace(const Polytope& polytope, std::uint32_t face, bool forward);
    bool liesOnTop(const Polytope& polytope, std::uint32_t cell, const SliceSet& out) const;
    void traceCell(const Polytope& polytope, std::uint32_t cell);
    void placeLoops(SliceSet& out);

    ConvexCut convexCut_;
    std::array<SliceSet, 2> singles_;               // slices in hyperplanes that the polytope touches
    std::vector<SliceSet*> touching_;               // by hyperplane: of these, or none
    std::vector<std::int32_t> allBelow_, allUpTo_;  // those of all hyperplanes, while one is cut
    // Of each vertex: the number of hyperplanes strictly below it, and of those below it or through it. They differ
    // where it lies in a hyperplane: in number below_.
    std::vector<std::int32_t> below_, upTo_, twice_;  // twice_: their sum
    bool anyLie_ = false;                             // whether they differ anywhere
    std::vector<std::uint32_t> vertexPoint_;          // the slice vertex of a vertex that lies in a hyperplane
    // A slot is an edge just above a hyperplane: of edge e above k, slotBegin_[e] + k − below_[lower end].
    std::vector<std::uint32_t> slotBegin_, slotPoint_;
    std::vector<std::uint32_t> lyingEdges_;  // those that lie in a hyperplane
    std::vector<std::uint32_t> edgeLine_;    // the slice edge of an edge that lies in a hyperplane
    std::vector<Line> lines_;                // of 2-face f: from lineBegin_[f]
    std::vector<std::uint32_t> lineBegin_;
    std::vector<Span> faceSpan_, cellSpan_;                       // strictly crossed
    std::vector<std::int32_t> lyingIn_;                           // the hyperplane that a whole 2-face lies in
    std::vector<std::uint32_t> next_, nextEdge_;                  // by slot: the way around a cell's section
    std::vector<std::pair<std::int32_t, std::uint32_t>> starts_;  // hyperplane and slot: links of the cell at hand
    std::vector<std::uint32_t> touchingFaces_;                    // 2-faces that the polytope touches a hyperplane with
    std::vector<bool> bounded_;                                   // by hyperplane: a 2-face in it bounds its slice
    std::vector<Loop> loops_;
    std::vector<std::array<std::uint32_t, 2>> loopCorners_;  // slice vertex, slice edge to the next corner
    std::vector<std::uint32_t> cursor_, cornerCursor_;
    std::vector<std::uint32_t> up_, down_;  // by hyperplane: the crossings of a convex 2-face
    std::vector<Crossing> ups_, downs_;     // in one hyperplane: those of any other
};

}  // namespace oval4d::geometry
