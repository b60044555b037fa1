// This file is long because its class is not divided: all stages of the slicing fill the same buffers, and no other
// code may see these buffers half filled.

#include "slicing/cell_complex_slicer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include <glm/geometric.hpp>

#include "slicing/listed_hyperplanes.hpp"
#include "slicing/prefix_sums.hpp"

// How the slicer treats vertices in hyperplanes: it cuts the complex just above each hyperplane, where there are no
// vertices, and then moves the section down into the hyperplane. A point on an edge that starts in the hyperplane moves
// to the vertex where the edge starts. A segment in a 2-face that has an edge in the hyperplane moves to this edge.
// Elements that shrink to a point are removed. Therefore vertices in the hyperplane need no special cases, and sections
// of cells are closed loops even if 2-faces are star polygons.

namespace oval4d::slicing {

void CellComplexSlicer::slice(const polytopes::Polytope& polytope, const geometry::Rotation& orientation,
                              const geometry::Hyperplanes& planes, SliceSet& out) {
    if (!planes.listed.empty()) {
        cutEachHyperplane(planes, out, [&](const geometry::Hyperplanes& plane, SliceSet& one) {
            slice(polytope, orientation, plane, one);
        });
        return;
    }
    out.planes = planes;
    locateVertices(polytope, orientation, out);
    if (!polytope.convex || !cutConvex(polytope, out)) cutGeneral(polytope, out);
}

void CellComplexSlicer::slice(const geometry::CellComplex& complex, const geometry::Rotation& orientation,
                              const geometry::Hyperplanes& planes, SliceSet& out) {
    if (!planes.listed.empty()) {
        cutEachHyperplane(planes, out, [&](const geometry::Hyperplanes& plane, SliceSet& one) {
            slice(complex, orientation, plane, one);
        });
        return;
    }
    out.planes = planes;
    locateVertices(complex, orientation, out);
    cutGeneral(complex, out);
}

void CellComplexSlicer::cutGeneral(const geometry::CellComplex& complex, SliceSet& out) {
    cutEdges(complex, out);
    cutFaces(complex, out);
    cutCells(complex, out);
}

bool CellComplexSlicer::cutConvex(const polytopes::Polytope& polytope, SliceSet& out) {
    touching_.clear();
    if (anyOnPlane_ && !cutTangentPlanes(polytope, out)) return false;
    return convexSlicer_.cut(polytope, {below_, upTo_, anyOnPlane_}, touching_, out);
}

// Finds the hyperplanes that touch the polytope (its supporting hyperplanes): each contains at least one vertex, and
// all other vertices lie in it or on one side of it. Cuts the slices in these hyperplanes by cutGeneral(), and sets
// their entries in touching_ to these slices. Returns false if there are more than two such hyperplanes, which happens
// only if hyperplanes are closer together than the tolerance.
bool CellComplexSlicer::cutTangentPlanes(const geometry::CellComplex& complex, SliceSet& out) {
    const std::int32_t firstAbove = *std::min_element(upTo_.begin(), upTo_.end());
    const std::int32_t lastBelow = *std::max_element(below_.begin(), below_.end());
    allBelow_ = below_;
    allUpTo_ = upTo_;
    touching_.resize(out.planes.count);
    std::size_t touched = 0;
    for (std::size_t v = 0; v < allBelow_.size(); ++v) {
        const std::int32_t k = allBelow_[v];
        if (k == allUpTo_[v] || (k >= firstAbove && k < lastBelow) || touching_[k] != nullptr) continue;
        if (touched++ == singles_.size()) break;
        touching_[k] = &singles_.at(touched - 1);
        cutOnePlane(complex, out, k, *touching_[k]);
    }
    below_.swap(allBelow_);
    upTo_.swap(allUpTo_);
    return touched <= singles_.size();
}

void CellComplexSlicer::cutOnePlane(const geometry::CellComplex& complex, SliceSet& all, std::int32_t plane,
                                    SliceSet& single) {
    for (std::size_t v = 0; v < below_.size(); ++v) {
        below_[v] = std::clamp(allBelow_[v] - plane, 0, 1);
        upTo_[v] = std::clamp(allUpTo_[v] - plane, 0, 1);
    }
    single.planes = {all.planes.first + plane, 1, all.planes.spacing, all.planes.offset};
    single.rotatedVertices.swap(all.rotatedVertices);
    cutGeneral(complex, single);
    single.rotatedVertices.swap(all.rotatedVertices);
}

void CellComplexSlicer::locateVertices(const geometry::CellComplex& complex, const geometry::Rotation& orientation,
                                       SliceSet& out) {
    const auto count = static_cast<double>(out.planes.count);
    const double inverse = 1 / out.planes.spacing;
    const double tolerance = kOnPlaneTolerance * complex.circumradius * inverse;
    const glm::dmat4 m = orientation.matrix();
    const std::size_t n = complex.vertices.size();
    out.rotatedVertices.resize(n);
    below_.resize(n);
    upTo_.resize(n);
    anyOnPlane_ = false;
    for (std::size_t v = 0; v < n; ++v) {
        out.rotatedVertices[v] = m * complex.vertices[v];
        const double level = (out.rotatedVertices[v].w - out.planes.offset) * inverse - out.planes.first;
        const double above = std::clamp(level - tolerance, 0.0, count);
        const auto whole = static_cast<std::int32_t>(above);
        below_[v] = whole + (above > whole ? 1 : 0);  // the number of hyperplanes below the vertex: `above`, rounded up
        upTo_[v] = static_cast<std::int32_t>(std::clamp(level + tolerance + 1, 0.0, count));
        anyOnPlane_ |= below_[v] != upTo_[v];
    }
}

// Finds the slice vertices: the vertices of the complex that lie in hyperplanes, and the points where its edges cross
// hyperplanes.
void CellComplexSlicer::cutEdges(const geometry::CellComplex& complex, SliceSet& out) {
    const auto edges = static_cast<std::uint32_t>(complex.edges.size());
    const auto vertices = static_cast<std::uint32_t>(complex.vertices.size());
    out.vertexBegin.assign(out.planes.count + 1, 0);
    for (std::uint32_t v = 0; v < vertices; ++v) {
        if (below_[v] != upTo_[v]) addToDifferences(out.vertexBegin, below_[v], upTo_[v]);
    }
    slotBegin_.resize(edges);
    std::uint32_t slots = 0;
    for (std::uint32_t e = 0; e < edges; ++e) {
        const auto [a, b] = complex.edges[e];
        slotBegin_[e] = slots;
        slots += std::abs(below_[a] - below_[b]);
        const std::int32_t from = std::min(upTo_[a], upTo_[b]);
        const std::int32_t to = std::max(below_[a], below_[b]);
        if (from < to) addToDifferences(out.vertexBegin, from, to);
    }
    const std::uint32_t total = differencesToRangeBegins(out.vertexBegin);
    out.vertices.resize(total);
    out.vertexSource.resize(total);
    vertexPoint_.resize(vertices);
    slotPoint_.resize(slots);
    cursor_.assign(out.vertexBegin.begin(), out.vertexBegin.end());

    for (std::uint32_t v = 0; v < vertices; ++v) {
        if (below_[v] == upTo_[v]) continue;
        const std::uint32_t point = cursor_[below_[v]]++;
        vertexPoint_[v] = point;
        out.vertices[point] = out.rotatedVertices[v];
        out.vertexSource[point] = edges + v;
    }
    std::uint32_t* slot = slotPoint_.data();
    for (std::uint32_t e = 0; e < edges; ++e) {
        auto [lower, upper] = complex.edges[e];
        if (below_[lower] == below_[upper]) continue;
        if (below_[lower] > below_[upper]) std::swap(lower, upper);
        std::int32_t k = below_[lower];
        if (k < upTo_[lower]) {
            *slot++ = vertexPoint_[lower];
            ++k;
        }
        const glm::dvec4& a = out.rotatedVertices[lower];
        const glm::dvec4 along = out.rotatedVertices[upper] - a;
        const glm::dvec3 perRise = glm::dvec3(along) * (1 / along.w);
        for (; k < below_[upper]; ++k) {
            const std::uint32_t point = cursor_[k]++;
            *slot++ = point;
            out.vertices[point] = glm::dvec3(a) + (out.planes.w(k) - a.w) * perRise;
            out.vertexSource[point] = e;
        }
    }
}

// Finds the slice edges: the edges of the complex that lie in hyperplanes, and the segments in which its 2-faces cross
// hyperplanes.
void CellComplexSlicer::cutFaces(const geometry::CellComplex& complex, SliceSet& out) {
    const auto faces = static_cast<std::uint32_t>(complex.faces.size());
    // upTo_[v] is either below_[v] or below_[v] + 1. Therefore, for the sum s = below_[v] + upTo_[v], below_[v] is
    // ⌊s/2⌋ and upTo_[v] is ⌈s/2⌉. So the least and the greatest s of a 2-face's vertices give the least and the
    // greatest below_ and upTo_.
    rankSum_.resize(below_.size());
    for (std::size_t v = 0; v < below_.size(); ++v) rankSum_[v] = below_[v] + upTo_[v];
    up_.resize(out.planes.count);
    down_.resize(out.planes.count);
    faceSpan_.resize(faces);
    lyingIn_.resize(faces);
    faceCrossingBegin_.resize(faces + 1);
    faceCrossings_.clear();
    const std::uint32_t* vertex = complex.faces.items.data();
    for (std::uint32_t f = 0; f < faces; ++f) {
        const std::uint32_t* end = complex.faces.items.data() + complex.faces.begin[f + 1];
        std::int32_t least = rankSum_[*vertex];
        std::int32_t most = least;
        while (++vertex != end) {
            least = std::min(least, rankSum_[*vertex]);
            most = std::max(most, rankSum_[*vertex]);
        }
        const HyperplaneRange above{least / 2, most / 2};
        const std::int32_t leastUpTo = (least + 1) / 2;
        const std::int32_t mostUpTo = (most + 1) / 2;
        faceSpan_[f] = {leastUpTo, above.to};
        lyingIn_[f] = above.from == above.to && leastUpTo == mostUpTo && leastUpTo > above.to ? above.to : kNoPlane;
        faceCrossingBegin_[f] = static_cast<std::uint32_t>(faceCrossings_.size());
        if (above.from == above.to) continue;
        if (above.from < faceSpan_[f].from) findLowestEdges(complex, f, above.from);
        if (!complex.convexFaces || !cutConvexFace(complex, f, above)) cutNonconvexFace(complex, f, above, out);
    }
    faceCrossingBegin_[faces] = static_cast<std::uint32_t>(faceCrossings_.size());
    numberEdges(complex, out);
}

// Adds the segments in which a convex 2-face crosses the levels just above the hyperplanes with the indices in `above`.
// The vertex loop of a convex 2-face ascends through each level once, and descends through it once. Returns false, and
// adds nothing, if the loop ascends through a level more than once: rounding errors can cause this if the 2-face nearly
// lies in a hyperplane.
bool CellComplexSlicer::cutConvexFace(const geometry::CellComplex& complex, std::uint32_t face, HyperplaneRange above) {
    const auto loop = complex.faces[face];
    const auto loopEdges = complex.faceEdges[face];
    std::int32_t ascents = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const std::int32_t from = below_[loop[i]];
        const std::int32_t to = below_[loop[i + 1 == loop.size() ? 0 : i + 1]];
        std::uint32_t slot = slotBegin_[loopEdges[i]];
        if (from < to) {
            ascents += to - from;
            for (std::int32_t k = from; k < to; ++k) up_[k] = slot++;
        } else {
            for (std::int32_t k = to; k < from; ++k) down_[k] = slot++;
        }
    }
    if (ascents != above.to - above.from) return false;
    for (std::int32_t k = above.from; k < above.to; ++k) addFaceCrossing(complex, face, k, up_[k], down_[k]);
    return true;
}

// Adds the segments in which a nonconvex 2-face crosses the levels just above the hyperplanes with the indices in
// `above`. The vertex loop of such a 2-face may cross a hyperplane several times. The crossings are sorted along the
// line in which the hyperplane cuts the plane of the 2-face. The i-th crossing where the loop ascends is then paired
// with the i-th crossing where it descends. Where the resulting segments overlap, the 2-face covers the line more than
// once.
void CellComplexSlicer::cutNonconvexFace(const geometry::CellComplex& complex, std::uint32_t face,
                                         HyperplaneRange above, const SliceSet& out) {
    const auto loop = complex.faces[face];
    const auto loopEdges = complex.faceEdges[face];
    for (std::int32_t k = above.from; k < above.to; ++k) {
        ups_.clear();
        downs_.clear();
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const std::int32_t from = below_[loop[i]];
            const std::int32_t to = below_[loop[i + 1 == loop.size() ? 0 : i + 1]];
            if (std::min(from, to) > k || std::max(from, to) <= k) continue;
            (from < to ? ups_ : downs_).push_back({slotBegin_[loopEdges[i]] + k - std::min(from, to), 0});
        }
        const glm::dvec3 origin = out.vertices[slotPoint_[ups_[0].slot]];
        glm::dvec3 direction(0);
        for (const auto* crossings : {&ups_, &downs_}) {
            for (const LoopCrossing& c : *crossings) {
                const glm::dvec3 d = out.vertices[slotPoint_[c.slot]] - origin;
                if (glm::dot(d, d) > glm::dot(direction, direction)) direction = d;
            }
        }
        for (auto* crossings : {&ups_, &downs_}) {
            for (LoopCrossing& c : *crossings) c.along = glm::dot(out.vertices[slotPoint_[c.slot]] - origin, direction);
            std::sort(crossings->begin(), crossings->end(),
                      [](const LoopCrossing& a, const LoopCrossing& b) { return a.along < b.along; });
        }
        for (std::size_t i = 0; i < ups_.size(); ++i) addFaceCrossing(complex, face, k, ups_[i].slot, downs_[i].slot);
    }
}

void CellComplexSlicer::findLowestEdges(const geometry::CellComplex& complex, std::uint32_t face, std::int32_t plane) {
    lowestEdges_.clear();
    for (const std::uint32_t e : complex.faceEdges[face]) {
        const auto [a, b] = complex.edges[e];
        if (!liesInHyperplane({a, b}) || below_[a] != plane) continue;
        const auto [first, last] = std::minmax(vertexPoint_[a], vertexPoint_[b]);
        lowestEdges_.push_back({first, last, e});
    }
    std::ranges::sort(lowestEdges_);
}

void CellComplexSlicer::addFaceCrossing(const geometry::CellComplex& complex, std::uint32_t face, std::int32_t plane,
                                        std::uint32_t up, std::uint32_t down) {
    std::uint32_t edge = kNewEdge;
    const std::uint32_t a = slotPoint_[up];
    const std::uint32_t b = slotPoint_[down];
    if (a == b) {
        edge = kNone;
    } else if (plane < faceSpan_[face].from) {
        // The lowest vertices of the 2-face lie in this hyperplane. The ends a and b of the segment move to two of
        // these vertices. If an edge of the 2-face joins the two vertices, the segment moves to this edge.
        const auto [first, last] = std::minmax(a, b);
        const auto after = std::upper_bound(lowestEdges_.begin(), lowestEdges_.end(), std::array{first, last, kNone});
        if (after != lowestEdges_.begin()) {
            const auto& [from, to, found] = *std::prev(after);
            if (from == first && to == last) edge = found;
        }
        // It is possible that no edge of the 2-face joins the two vertices. In a complex without cells, the 2-faces
        // need not be flat; the slice then has no segment between the vertices. In a complex with cells, only rounding
        // errors can cause this, if the 2-face nearly lies in the hyperplane. The segment is then kept, because the
        // section of a cell must be closed.
        if (edge == kNewEdge && complex.cells.size() == 0) edge = kNone;
    }
    faceCrossings_.push_back({plane, up, down, edge});
}

void CellComplexSlicer::numberEdges(const geometry::CellComplex& complex, SliceSet& out) {
    const auto edges = static_cast<std::uint32_t>(complex.edges.size());
    const auto faces = static_cast<std::uint32_t>(complex.faces.size());
    out.edgeBegin.assign(out.planes.count + 1, 0);
    lyingEdges_.clear();
    for (std::uint32_t e = 0; e < edges; ++e) {
        if (!liesInHyperplane(complex.edges[e])) continue;
        lyingEdges_.push_back(e);
        const std::int32_t plane = below_[complex.edges[e][0]];
        addToDifferences(out.edgeBegin, plane, plane + 1);
    }
    for (const FaceCrossing& crossing : faceCrossings_) {
        if (crossing.edge == kNewEdge) addToDifferences(out.edgeBegin, crossing.plane, crossing.plane + 1);
    }
    const std::uint32_t total = differencesToRangeBegins(out.edgeBegin);
    out.edges.resize(total);
    out.edgeSource.resize(total);
    sliceEdgeOf_.resize(edges);
    cursor_.assign(out.edgeBegin.begin(), out.edgeBegin.end());
    const auto add = [&](std::int32_t plane, std::uint32_t a, std::uint32_t b, std::uint32_t source) {
        const std::uint32_t number = cursor_[plane]++;
        out.edges[number] = {a - out.vertexBegin[plane], b - out.vertexBegin[plane]};
        out.edgeSource[number] = source;
        return number;
    };
    for (const std::uint32_t e : lyingEdges_) {
        const auto [a, b] = complex.edges[e];
        sliceEdgeOf_[e] = add(below_[a], vertexPoint_[a], vertexPoint_[b], faces + e);
    }
    for (std::uint32_t f = 0; f < faces; ++f) {
        for (std::uint32_t i = faceCrossingBegin_[f]; i < faceCrossingBegin_[f + 1]; ++i) {
            FaceCrossing& crossing = faceCrossings_[i];
            if (crossing.edge == kNone) continue;
            crossing.edge = crossing.edge == kNewEdge
                                ? add(crossing.plane, slotPoint_[crossing.up], slotPoint_[crossing.down], f)
                                : sliceEdgeOf_[crossing.edge];
        }
    }
}

// Finds the slice faces: the 2-faces of the complex that lie in hyperplanes, and the polygons in which its cells cross
// hyperplanes.
void CellComplexSlicer::cutCells(const geometry::CellComplex& complex, SliceSet& out) {
    const auto cells = static_cast<std::uint32_t>(complex.cells.size());
    cellSpan_.resize(cells);
    for (std::uint32_t c = 0; c < cells; ++c) {
        const auto faces = complex.cells[c];
        HyperplaneRange span = faceSpan_[faces[0]];
        for (const std::uint32_t f : faces) {
            span = {std::min(span.from, faceSpan_[f].from), std::max(span.to, faceSpan_[f].to)};
        }
        cellSpan_[c] = span;
    }
    lowestSectionCollapses_.assign(cells, true);
    for (std::uint32_t c = 0; c < cells && anyOnPlane_; ++c)
        lowestSectionCollapses_[c] = lowestSectionCollapses(complex, c, out);
    loops_.clear();
    loopCorners_.clear();
    coinciding_.begin(static_cast<std::uint32_t>(out.edges.size()));
    next_.assign(slotPoint_.size(), kNone);
    nextEdge_.resize(slotPoint_.size());
    if (cells > 0) addFacesInHyperplanes(complex, out);
    for (std::uint32_t c = 0; c < cells; ++c) {
        if (cellSpan_[c].from < cellSpan_[c].to || !lowestSectionCollapses_[c]) traceCell(complex, c);
    }
    if (coinciding_.anyCoincide()) removeCoincidingEdges(out);
    writeLoops(out);
}

// Must be called after numberEdges().
bool CellComplexSlicer::lowestSectionCollapses(const geometry::CellComplex& complex, std::uint32_t cell,
                                               const SliceSet& out) const {
    const auto faces = static_cast<std::uint32_t>(complex.faces.size());
    for (const std::uint32_t f : complex.cells[cell]) {
        for (std::uint32_t i = faceCrossingBegin_[f]; i < faceCrossingBegin_[f + 1]; ++i) {
            const FaceCrossing& crossing = faceCrossings_[i];
            if (crossing.plane >= cellSpan_[cell].from) break;  // the crossings of a 2-face are sorted by hyperplane
            if (crossing.edge != kNone && out.edgeSource[crossing.edge] < faces) return false;
        }
    }
    return true;
}

// Traces the sections of a cell. The cell's 2-faces were cut in segments. Each segment is directed by the orientation
// of its 2-face in this cell, so the end of a segment is the start of the next one. Links each segment to the next,
// then follows the links to find the closed loops.
void CellComplexSlicer::traceCell(const geometry::CellComplex& complex, std::uint32_t cell) {
    const HyperplaneRange span = cellSpan_[cell];
    starts_.clear();
    for (std::uint32_t at = complex.cells.begin[cell]; at < complex.cells.begin[cell + 1]; ++at) {
        const std::uint32_t f = complex.cells.items[at];
        const bool outward = complex.cellSigns[at] > 0;
        for (std::uint32_t i = faceCrossingBegin_[f]; i < faceCrossingBegin_[f + 1]; ++i) {
            const FaceCrossing& crossing = faceCrossings_[i];
            if (crossing.plane < span.from && lowestSectionCollapses_[cell])
                continue;  // the cell only touches this hyperplane: see addFacesInHyperplanes()
            const std::uint32_t from = outward ? crossing.up : crossing.down;
            next_[from] = outward ? crossing.down : crossing.up;
            nextEdge_[from] = crossing.edge;
            starts_.emplace_back(crossing.plane, from);
        }
    }
    for (const auto& [plane, start] : starts_) {
        if (next_[start] == kNone) continue;
        SliceFaceLoop loop{plane, cell, static_cast<std::uint32_t>(loopCorners_.size()), 0};
        for (std::uint32_t slot = start; next_[slot] != kNone;) {
            if (nextEdge_[slot] != kNone) loopCorners_.push_back({slotPoint_[slot], nextEdge_[slot]});
            slot = std::exchange(next_[slot], kNone);
        }
        loop.size = static_cast<std::uint32_t>(loopCorners_.size()) - loop.begin;
        if (loop.size >= 3) {
            loops_.push_back(loop);
        } else {
            if (loop.size == 2)
                coinciding_.markCoinciding(loopCorners_[loop.begin][1], loopCorners_[loop.begin + 1][1]);
            loopCorners_.resize(loop.begin);
        }
    }
}

// Adds the slice faces that are 2-faces lying in a hyperplane. Such a 2-face is a face of the slice in two cases:
// - Exactly one of its two cells stands on it, above the hyperplane.
// - One of its cells lies in the hyperplane, on top of the complex.
//
// In both cases, the slice face has the orientation that the 2-face has in this one cell. If the complex only touches
// the hyperplane in a 2-face, this 2-face is the whole slice.
void CellComplexSlicer::addFacesInHyperplanes(const geometry::CellComplex& complex, const SliceSet& out) {
    touchingFaces_.clear();
    bounded_.assign(out.planes.count, false);
    upward_.assign(complex.cells.size(), std::nullopt);
    const auto isUpward = [&](std::uint32_t cell) {
        std::optional<bool>& known = upward_[cell];
        if (!known) known = hasUpwardNormal(complex, cell, out);
        return *known;
    };
    for (std::uint32_t f = 0; f < complex.faces.size(); ++f) {
        const std::int32_t plane = lyingIn_[f];
        if (plane == kNoPlane) continue;
        std::array<bool, 2> standsOnFace{};
        std::array<bool, 2> bounds{};
        for (std::size_t i = 0; i < 2; ++i) {
            const std::uint32_t cell = complex.faceCells[f].at(i);
            const HyperplaneRange span = cellSpan_[cell];
            standsOnFace.at(i) = span.from > plane && span.to > plane && lowestSectionCollapses_[cell];
            bounds.at(i) = standsOnFace.at(i) || (span.from > plane && span.to <= plane && isUpward(cell));
        }
        if ((standsOnFace[0] && standsOnFace[1]) || (!bounds[0] && !bounds[1])) {
            touchingFaces_.push_back(f);
            continue;
        }
        for (std::size_t i = 0; i < 2; ++i) {
            // The loop of a 2-face is counterclockwise seen from outside its second cell: see CellComplex::faceCells.
            if (bounds.at(i)) addFaceInHyperplane(complex, f, i == 1);
        }
    }
    for (const std::uint32_t f : touchingFaces_) {
        bool alone = true;
        for (const std::uint32_t cell : complex.faceCells[f]) {
            const bool stands = cellSpan_[cell].from > lyingIn_[f] && lowestSectionCollapses_[cell];
            alone = alone && (stands || cellSpan_[cell].to <= lyingIn_[f]);
        }
        if (alone && !bounded_[lyingIn_[f]]) addFaceInHyperplane(complex, f, true);
    }
}

void CellComplexSlicer::addFaceInHyperplane(const geometry::CellComplex& complex, std::uint32_t face, bool forward) {
    const auto loop = complex.faces[face];
    const std::size_t n = loop.size();
    bounded_[lyingIn_[face]] = true;
    loops_.push_back({lyingIn_[face], static_cast<std::uint32_t>(complex.cells.size()) + face,
                      static_cast<std::uint32_t>(loopCorners_.size()), static_cast<std::uint32_t>(n)});
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t corner = forward ? i : (n - i) % n;
        const std::size_t edge = forward ? i : n - 1 - i;
        loopCorners_.push_back({vertexPoint_[loop[corner]], sliceEdgeOf_[complex.faceEdges[face][edge]]});
    }
}

// Returns whether a cell that lies in a hyperplane is on top of the complex, so that its outer side faces toward larger
// w. Divides the 2-faces of the cell, oriented as in this cell, into triangles with the corners a, b and c. The cell is
// on top if the sum of det(a, b, c) over these triangles is positive.
bool CellComplexSlicer::hasUpwardNormal(const geometry::CellComplex& complex, std::uint32_t cell,
                                        const SliceSet& out) const {
    double volume = 0;
    for (std::uint32_t at = complex.cells.begin[cell]; at < complex.cells.begin[cell + 1]; ++at) {
        const auto loop = complex.faces[complex.cells.items[at]];
        const glm::dvec3 first(out.rotatedVertices[loop[0]]);
        for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
            const glm::dvec3 normal =
                glm::cross(glm::dvec3(out.rotatedVertices[loop[i]]), glm::dvec3(out.rotatedVertices[loop[i + 1]]));
            volume += complex.cellSigns[at] * glm::dot(first, normal);
        }
    }
    return volume > 0;
}

void CellComplexSlicer::removeCoincidingEdges(SliceSet& out) {
    std::vector<std::uint32_t> number(out.edges.size());
    std::uint32_t kept = 0;
    for (int k = 0; k < out.planes.count; ++k) {
        const std::uint32_t begin = out.edgeBegin[k], end = out.edgeBegin[k + 1];
        out.edgeBegin[k] = kept;
        for (std::uint32_t e = begin; e < end; ++e) {
            if (const std::uint32_t first = coinciding_.representativeOf(e); first != e) {
                number[e] = number[first];
                continue;
            }
            out.edges[kept] = out.edges[e];
            out.edgeSource[kept] = out.edgeSource[e];
            number[e] = kept++;
        }
    }
    out.edgeBegin[out.planes.count] = kept;
    out.edges.resize(kept);
    out.edgeSource.resize(kept);
    for (auto& corner : loopCorners_) corner[1] = number[corner[1]];
}

// Writes the faces of loops_ to `out`, sorted by hyperplane.
void CellComplexSlicer::writeLoops(SliceSet& out) {
    out.faceBegin.assign(out.planes.count + 1, 0);
    cornerCursor_.assign(out.planes.count + 1, 0);
    for (const SliceFaceLoop& loop : loops_) {
        addToDifferences(out.faceBegin, loop.plane, loop.plane + 1);
        cornerCursor_[loop.plane] += loop.size;
        cornerCursor_[loop.plane + 1] -= loop.size;
    }
    const std::uint32_t total = differencesToRangeBegins(out.faceBegin);
    const std::uint32_t corners = differencesToRangeBegins(cornerCursor_);
    out.faceSource.resize(total);
    out.cornerBegin.resize(total + 1);
    out.cornerBegin[total] = corners;
    out.corners.resize(corners);
    out.cornerEdges.resize(corners);
    cursor_.assign(out.faceBegin.begin(), out.faceBegin.end());
    for (const SliceFaceLoop& loop : loops_) {
        const std::uint32_t face = cursor_[loop.plane]++;
        std::uint32_t& corner = cornerCursor_[loop.plane];
        const std::uint32_t firstVertex = out.vertexBegin[loop.plane];
        const std::uint32_t firstEdge = out.edgeBegin[loop.plane];
        out.faceSource[face] = loop.source;
        out.cornerBegin[face] = corner;
        for (std::uint32_t i = loop.begin; i < loop.begin + loop.size; ++i, ++corner) {
            out.corners[corner] = loopCorners_[i][0] - firstVertex;
            out.cornerEdges[corner] = loopCorners_[i][1] - firstEdge;
        }
    }
}

}  // namespace oval4d::slicing
