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

/// Slices polytopes, convex or not, and other cell complexes. Reuses its memory, so that repeated calls of similar size
/// allocate nothing. Only one thread at a time may use a slicer.
class CellComplexSlicer {
  public:
    /// If `forkJoin` is not null, may slice large convex polytopes on two cores. `forkJoin` must outlive this object.
    explicit CellComplexSlicer(parallel::ForkJoin* forkJoin = nullptr) : convexSlicer_(forkJoin) {}

    /// Slices an object rotated by `orientation`. A slice of a cell complex without cells has no faces: where a 2-face
    /// lies in the hyperplane, the slice has its edges. Overwrites `out`, except ballScale, ballOpacity, surfaces and
    /// fogs, and reuses its memory.
    void slice(const polytopes::Polytope& polytope, const geometry::Rotation& orientation,
               const geometry::Hyperplanes& planes, SliceSet& out);
    void slice(const geometry::CellComplex& complex, const geometry::Rotation& orientation,
               const geometry::Hyperplanes& planes, SliceSet& out);

  private:
    static constexpr std::int32_t kNoPlane = -1;
    static constexpr std::uint32_t kNone = 0xffffffffU;
    static constexpr std::uint32_t kNewEdge = 0xfffffffeU;  // see FaceCrossing

    // The hyperplanes with the indices in [from, to); no hyperplane if to ≤ from.
    struct PlaneRange {
        std::int32_t from, to;
    };
    // A segment in which a 2-face crosses the level just above hyperplane `plane`. It runs from slot `up`, where the
    // vertex loop of the 2-face rises through this level, to slot `down`, where the loop descends (for slots, see
    // slotBegin_). The segment is then moved down into the hyperplane. `edge` is kNone if no slice edge results, for
    // example because the segment shrinks to a point. Otherwise, before numberEdges(), `edge` is the edge of the
    // complex to which the segment moves, or kNewEdge if it moves to no edge of the complex; numberEdges() then sets
    // `edge` to the slice edge of the segment.
    struct FaceCrossing {
        std::int32_t plane;
        std::uint32_t up, down;
        std::uint32_t edge;
    };
    // A face of the slice in hyperplane `plane`: a closed loop with `size` corners, of which loopCorners_[begin] is the
    // first. `source` is the entry of SliceSet::faceSource: it says from which cell or 2-face the slice face was cut.
    struct FaceLoop {
        std::int32_t plane;
        std::uint32_t source, begin, size;
    };
    // A point where the vertex loop of a 2-face crosses a hyperplane.
    struct LoopCrossing {
        std::uint32_t slot;
        double along;  // position on the line in which the hyperplane cuts the 2-face's plane, in arbitrary units
    };

    // Rotates the vertices and counts the hyperplanes below each vertex.
    void locateVertices(const geometry::CellComplex& complex, const geometry::Rotation& orientation, SliceSet& out);
    // Cuts all slices by the general method, which also handles nonconvex polytopes and other cell complexes.
    void cutGeneral(const geometry::CellComplex& complex, SliceSet& out);
    // Cuts all slices of a convex polytope by the faster ConvexSlicer. Returns false, and leaves `out` unusable, if
    // more than two hyperplanes touch the polytope or if rounding errors prevent the cut.
    bool cutConvex(const polytopes::Polytope& polytope, SliceSet& out);
    bool cutTangentPlanes(const geometry::CellComplex& complex, SliceSet& out);
    // Cuts one slice, in the hyperplane with the index `plane` in `all.planes`, and writes it to `single`. Moves
    // `all.rotatedVertices` to `single` for the cut, and back at the end.
    void cutOnePlane(const geometry::CellComplex& complex, SliceSet& all, std::int32_t plane, SliceSet& single);
    void cutEdges(const geometry::CellComplex& complex, SliceSet& out);
    void cutFaces(const geometry::CellComplex& complex, SliceSet& out);
    bool cutConvexFace(const geometry::CellComplex& complex, std::uint32_t face, PlaneRange above);
    void cutNonconvexFace(const geometry::CellComplex& complex, std::uint32_t face, PlaneRange above,
                          const SliceSet& out);
    // Sets lowestEdges_ to the edges of the 2-face that lie in the hyperplane `plane`. This hyperplane must contain the
    // lowest vertices of the 2-face.
    void findLowestEdges(const geometry::CellComplex& complex, std::uint32_t face, std::int32_t plane);
    void addFaceCrossing(const geometry::CellComplex& complex, std::uint32_t face, std::int32_t plane, std::uint32_t up,
                         std::uint32_t down);
    void numberEdges(const geometry::CellComplex& complex, SliceSet& out);
    // Returns whether the whole edge lies in a hyperplane.
    bool liesInHyperplane(const std::array<std::uint32_t, 2>& edge) const {
        return below_[edge[0]] == below_[edge[1]] && below_[edge[0]] < upTo_[edge[0]] &&
               below_[edge[1]] < upTo_[edge[1]];
    }
    void cutCells(const geometry::CellComplex& complex, SliceSet& out);
    // Returns true if none of the slicing hyperplanes contains the cell's lowest vertices. Otherwise, let H be the
    // hyperplane that contains them. Just above H, the cell's 2-faces are cut in segments, which are then moved down
    // into H. Returns true if each of them becomes an edge of the complex or a point: the cell then only touches H.
    // Returns false if a segment stays inside a 2-face: the cell then nearly lies in H, and is cut in H, too.
    bool lowestSectionCollapses(const geometry::CellComplex& complex, std::uint32_t cell, const SliceSet& out) const;
    void addLyingFaces(const geometry::CellComplex& complex, const SliceSet& out);
    void addLyingFace(const geometry::CellComplex& complex, std::uint32_t face, bool forward);
    bool hasUpwardNormal(const geometry::CellComplex& complex, std::uint32_t cell, const SliceSet& out) const;
    void traceCell(const geometry::CellComplex& complex, std::uint32_t cell);
    void removeCoincidingEdges(SliceSet& out);
    void placeLoops(SliceSet& out);

    ConvexSlicer convexSlicer_;
    std::array<SliceSet, 2> singles_;               // the slices in hyperplanes that the polytope touches from one side
    std::vector<SliceSet*> touching_;               // per hyperplane: an element of singles_, or null
    std::vector<std::int32_t> allBelow_, allUpTo_;  // below_ and upTo_ for all hyperplanes, during cutTangentPlanes()
    // Per vertex: the number of hyperplanes strictly below it, and the number of hyperplanes below or through it. The
    // numbers differ if the vertex lies in a hyperplane; the index of this hyperplane is below_.
    std::vector<std::int32_t> below_, upTo_, rankSum_;  // rankSum_: below_ + upTo_ (see cutFaces())
    bool anyOnPlane_ = false;                           // whether any vertex lies in a hyperplane
    // In the members below, slice vertices and slice edges are given by their indices in SliceSet::vertices and
    // SliceSet::edges, which are counted over all slices.
    std::vector<std::uint32_t> vertexPoint_;  // per vertex that lies in a hyperplane: its slice vertex
    // A slot is the crossing of an edge with the level just above a hyperplane: for edge e and hyperplane k, its index
    // is slotBegin_[e] + k − below_[lower end of e]. slotPoint_ is the slice vertex of each slot.
    std::vector<std::uint32_t> slotBegin_, slotPoint_;
    std::vector<std::uint32_t> lyingEdges_;    // edges that lie in a hyperplane
    std::vector<std::uint32_t> sliceEdgeOf_;   // per edge that lies in a hyperplane: its slice edge
    std::vector<FaceCrossing> faceCrossings_;  // those of 2-face f begin at faceCrossingBegin_[f]
    std::vector<std::uint32_t> faceCrossingBegin_;
    // Per 2-face or cell: the hyperplanes strictly between its lowest and its highest vertex.
    std::vector<PlaneRange> faceSpan_, cellSpan_;
    std::vector<std::int32_t> lyingIn_;         // per 2-face: the hyperplane that contains all of it, or kNoPlane
    std::vector<bool> lowestSectionCollapses_;  // per cell: the result of lowestSectionCollapses()
    CoincidingEdges coinciding_;                // the slice edges that coincide
    // Per slot (see slotBegin_), while a cell is traced: the next slot around the section of the cell, and the slice
    // edge that leads to this next slot. next_ is kNone for a slot that has no next slot or has already been traced.
    std::vector<std::uint32_t> next_, nextEdge_;
    // The slots that have a next slot in the current cell, each with the index of its hyperplane. The tracing of loops
    // starts at these slots.
    std::vector<std::pair<std::int32_t, std::uint32_t>> starts_;
    std::vector<std::uint32_t> touchingFaces_;  // 2-faces that lie in a hyperplane and may be the whole slice in it
    std::vector<bool> bounded_;                 // per hyperplane: whether a 2-face in it is a slice face
    std::vector<std::optional<bool>> upward_;   // per cell: the result of hasUpwardNormal(), if it is known
    std::vector<FaceLoop> loops_;
    // Per corner: its slice vertex, and the slice edge to the next corner.
    std::vector<std::array<std::uint32_t, 2>> loopCorners_;
    std::vector<std::uint32_t> cursor_, cornerCursor_;  // per hyperplane: the index at which to write the next element
    std::vector<std::uint32_t> up_, down_;  // per hyperplane: the slots where a convex 2-face's loop rises and descends
    // Of the current 2-face: the edges in the hyperplane of its lowest vertices. Each entry has the slice vertices at
    // the two ends of an edge, in ascending order, and the index of the edge; the entries are sorted.
    std::vector<std::array<std::uint32_t, 3>> lowestEdges_;
    std::vector<LoopCrossing> ups_, downs_;  // in one hyperplane: where a nonconvex 2-face's loop rises and descends
};

}  // namespace oval4d::slicing
