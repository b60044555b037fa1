#pragma once
// Slices a polytope or another cell complex by parallel hyperplanes w = const.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "geometry/cell_complex.hpp"
#include "geometry/rotation.hpp"
#include "parallel/fork_join.hpp"
#include "polytopes/polytope.hpp"
#include "slicing/coinciding_edges.hpp"
#include "slicing/convex_slicer.hpp"
#include "slicing/slice_set.hpp"

namespace oval4d::slicing {

/// Slices polytopes, convex or not, and other cell complexes by parallel hyperplanes. Reuses its memory, so that
/// repeated calls of similar size allocate nothing. Only one thread at a time may use a slicer.
class CellComplexSlicer {
  public:
    /// If `forkJoin` is not null, the slicer may use it to slice large convex polytopes on two cores. `forkJoin` must
    /// outlive this object.
    explicit CellComplexSlicer(parallel::ForkJoin* forkJoin = nullptr) : convexSlicer_(forkJoin) {}

    /// Slices `polytope` or `complex`, rotated by `orientation`, by all hyperplanes of `planes`, and writes the slices
    /// to `out`. Slices of a cell complex without cells have no faces: where a 2-face lies in the hyperplane, the slice
    /// has only the edges of this 2-face. Overwrites `out` and reuses its memory, but keeps its ballScale, ballOpacity,
    /// surfaces and fogs.
    void slice(const polytopes::Polytope& polytope, const geometry::Rotation& orientation,
               const geometry::Hyperplanes& planes, SliceSet& out);
    void slice(const geometry::CellComplex& complex, const geometry::Rotation& orientation,
               const geometry::Hyperplanes& planes, SliceSet& out);

  private:
    static constexpr std::int32_t kNoPlane = -1;
    static constexpr std::uint32_t kNone = 0xffffffffU;
    // A value of FaceCrossing::edge: the segment becomes a new slice edge.
    static constexpr std::uint32_t kNewEdge = 0xfffffffeU;

    // A range of hyperplanes: those with the indices in [from, to). The range is empty if to ≤ from.
    struct HyperplaneRange {
        std::int32_t from, to;
    };
    // A segment in which a 2-face crosses the level just above the hyperplane with the index `plane`. The segment runs
    // from slot `up`, where the vertex loop of the 2-face rises through this level, to slot `down`, where the loop
    // descends. (A slot is a crossing of an edge with such a level: see slotBegin_.) The segment is then moved down
    // into the hyperplane.
    //
    // `edge` is kNone if no slice edge results, for example because the segment shrinks to a point. Before
    // numberEdges(), any other value of `edge` is the edge of the complex to which the segment moves, or kNewEdge if
    // there is no such edge. numberEdges() replaces the value by the index of the slice edge that the segment becomes.
    struct FaceCrossing {
        std::int32_t plane;
        std::uint32_t up, down;
        std::uint32_t edge;
    };
    // A face of the slice in the hyperplane with the index `plane`: a closed loop of `size` corners. Its first corner
    // is loopCorners_[begin]. `source` is the entry of the face in SliceSet::faceSource: it says from which cell or
    // 2-face of the complex the face was cut.
    struct SliceFaceLoop {
        std::int32_t plane;
        std::uint32_t source, begin, size;
    };
    // A point where the vertex loop of a 2-face crosses a hyperplane. `slot` is the number of the crossing of an edge
    // with this hyperplane (see slotBegin_).
    struct LoopCrossing {
        std::uint32_t slot;
        // The coordinate of the point along the line in which the hyperplane cuts the plane of the 2-face, in arbitrary
        // units.
        double along;
    };

    // Rotates the vertices of the complex, and counts the hyperplanes below each vertex.
    void locateVertices(const geometry::CellComplex& complex, const geometry::Rotation& orientation, SliceSet& out);
    // Cuts all slices by the general method, which also handles nonconvex polytopes and other cell complexes.
    void cutGeneral(const geometry::CellComplex& complex, SliceSet& out);
    // Cuts all slices of a convex polytope with ConvexSlicer, which is faster than cutGeneral(). Returns false, and
    // leaves `out` unusable, if more than two hyperplanes touch the polytope from one side, or if rounding errors
    // prevent the cut.
    bool cutConvex(const polytopes::Polytope& polytope, SliceSet& out);
    bool cutTangentPlanes(const geometry::CellComplex& complex, SliceSet& out);
    // Cuts the slice in the hyperplane with the index `plane` in `all.planes`, and writes this slice to `single`. Moves
    // `all.rotatedVertices` to `single` for the cut, and back to `all` at the end.
    void cutOnePlane(const geometry::CellComplex& complex, SliceSet& all, std::int32_t plane, SliceSet& single);
    void cutEdges(const geometry::CellComplex& complex, SliceSet& out);
    void cutFaces(const geometry::CellComplex& complex, SliceSet& out);
    bool cutConvexFace(const geometry::CellComplex& complex, std::uint32_t face, HyperplaneRange above);
    void cutNonconvexFace(const geometry::CellComplex& complex, std::uint32_t face, HyperplaneRange above,
                          const SliceSet& out);
    // Sets lowestEdges_ to the edges of the 2-face `face` that lie in the hyperplane with the index `plane`. This
    // hyperplane must contain the lowest vertices of the 2-face.
    void findLowestEdges(const geometry::CellComplex& complex, std::uint32_t face, std::int32_t plane);
    void addFaceCrossing(const geometry::CellComplex& complex, std::uint32_t face, std::int32_t plane, std::uint32_t up,
                         std::uint32_t down);
    void numberEdges(const geometry::CellComplex& complex, SliceSet& out);
    // Returns whether both ends of the edge lie in the same hyperplane.
    bool liesInHyperplane(const std::array<std::uint32_t, 2>& edge) const {
        return below_[edge[0]] == below_[edge[1]] && below_[edge[0]] < upTo_[edge[0]] &&
               below_[edge[1]] < upTo_[edge[1]];
    }
    void cutCells(const geometry::CellComplex& complex, SliceSet& out);
    // Returns true if the cell only touches the hyperplane H that contains its lowest vertices, or if no slicing
    // hyperplane contains them. Just above H, the cell's 2-faces are cut in segments, which are then moved down into H.
    // The cell only touches H if each segment becomes an edge of the complex or a point. Returns false if a segment
    // stays inside a 2-face: the cell then nearly lies in H, and the slice in H includes a section of the cell.
    bool lowestSectionCollapses(const geometry::CellComplex& complex, std::uint32_t cell, const SliceSet& out) const;
    void addFacesInHyperplanes(const geometry::CellComplex& complex, const SliceSet& out);
    void addFaceInHyperplane(const geometry::CellComplex& complex, std::uint32_t face, bool forward);
    bool hasUpwardNormal(const geometry::CellComplex& complex, std::uint32_t cell, const SliceSet& out) const;
    void traceCell(const geometry::CellComplex& complex, std::uint32_t cell);
    void removeCoincidingEdges(SliceSet& out);
    void writeLoops(SliceSet& out);

    ConvexSlicer convexSlicer_;
    // The slices in the at most two hyperplanes that touch the polytope from one side.
    std::array<SliceSet, 2> singles_;
    std::vector<SliceSet*> touching_;               // per hyperplane: the slice of singles_ in this hyperplane, or null
    std::vector<std::int32_t> allBelow_, allUpTo_;  // during cutTangentPlanes(): below_ and upTo_ for all hyperplanes
    // below_ has, per vertex, the number of hyperplanes strictly below the vertex. upTo_ has, per vertex, the number of
    // hyperplanes below or through it. If a vertex lies in a hyperplane, its two numbers differ, and its number in
    // below_ is the index of this hyperplane.
    std::vector<std::int32_t> below_, upTo_, rankSum_;  // rankSum_: per vertex, below_ + upTo_ (see cutFaces())
    bool anyOnPlane_ = false;                           // whether any vertex lies in a hyperplane
    // The members below give slice vertices and slice edges by their indices in SliceSet::vertices and SliceSet::edges,
    // which are counted over all slices.
    std::vector<std::uint32_t> vertexPoint_;  // per vertex that lies in a hyperplane: the slice vertex at this place
    // A slot is the crossing of an edge of the complex with the level just above a hyperplane. For edge e and the
    // hyperplane with the index k, the number of the slot is slotBegin_[e] + k − below_[lower end of e]. slotPoint_ has
    // the slice vertex of each slot.
    std::vector<std::uint32_t> slotBegin_, slotPoint_;
    std::vector<std::uint32_t> lyingEdges_;  // the edges of the complex that lie in a hyperplane
    // Per edge of the complex that lies in a hyperplane: the slice edge that it becomes.
    std::vector<std::uint32_t> sliceEdgeOf_;
    // The crossings of all 2-faces; those of 2-face f begin at faceCrossingBegin_[f].
    std::vector<FaceCrossing> faceCrossings_;
    std::vector<std::uint32_t> faceCrossingBegin_;
    // Per 2-face or cell of the complex: the range of the hyperplanes strictly between its lowest and its highest
    // vertex.
    std::vector<HyperplaneRange> faceSpan_, cellSpan_;
    std::vector<std::int32_t> lyingIn_;  // per 2-face: the hyperplane in which all of the 2-face lies, or kNoPlane
    std::vector<bool> lowestSectionCollapses_;  // per cell: the result of the function lowestSectionCollapses()
    CoincidingEdges coinciding_;                // the groups of slice edges that coincide
    // These lists are used while the section of one cell is traced. Per slot (see slotBegin_): next_ has the next slot
    // around the section, and nextEdge_ the slice edge that leads to this next slot. next_ is kNone for a slot that has
    // no next slot, or that has already been traced.
    std::vector<std::uint32_t> next_, nextEdge_;
    // The slots (crossings of edges with hyperplanes) at which the tracing of loops starts: all those that have a next
    // slot in the section of the current cell. Each slot is preceded by the index of its hyperplane.
    std::vector<std::pair<std::int32_t, std::uint32_t>> starts_;
    // The 2-faces that lie in a hyperplane and are not faces of a larger slice there. Each may be the whole slice (see
    // addFacesInHyperplanes()).
    std::vector<std::uint32_t> touchingFaces_;
    std::vector<bool> bounded_;  // per hyperplane: whether a 2-face that lies in the hyperplane is a slice face
    std::vector<std::optional<bool>> upward_;  // per cell: the result of hasUpwardNormal(); empty if not yet computed
    std::vector<SliceFaceLoop> loops_;
    // Per corner of a loop: the slice vertex at the corner, and the slice edge that leads to the next corner.
    std::vector<std::array<std::uint32_t, 2>> loopCorners_;
    // Per hyperplane: the index at which the next vertex, edge or face (cursor_) or corner (cornerCursor_) is written.
    std::vector<std::uint32_t> cursor_, cornerCursor_;
    // Per hyperplane: the slot (crossing of an edge) where the vertex loop of a convex 2-face rises through the
    // hyperplane (up_), and the slot where the loop descends through it (down_).
    std::vector<std::uint32_t> up_, down_;
    // The edges of the current 2-face that lie in the hyperplane of its lowest vertices. Each entry has the slice
    // vertices at the two ends of an edge, in ascending order, and then the index of the edge. The entries are sorted.
    std::vector<std::array<std::uint32_t, 3>> lowestEdges_;
    // Where the vertex loop of a nonconvex 2-face rises through one hyperplane (ups_) and descends through it (downs_).
    std::vector<LoopCrossing> ups_, downs_;
};

}  // namespace oval4d::slicing
