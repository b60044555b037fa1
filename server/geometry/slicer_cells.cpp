// How the slicer makes faces: loops around cells, and 2-faces that lie in a hyperplane.

#include <algorithm>
#include <utility>

#include <glm/geometric.hpp>

#include "geometry/ranges.hpp"
#include "geometry/slicer.hpp"

namespace oval4d::geometry {

// Slice faces: the 2-faces in the hyperplane, and the crossed cells.
void Slicer::cutCells(const Polytope& polytope, SliceSet& out) {
    const auto cells = static_cast<std::uint32_t>(polytope.cells.size());
    cellSpan_.resize(cells);
    for (std::uint32_t c = 0; c < cells; ++c) {
        const auto faces = polytope.cells[c];
        Span span = faceSpan_[faces[0]];
        for (const std::uint32_t f : faces) {
            span = {std::min(span.from, faceSpan_[f].from), std::max(span.to, faceSpan_[f].to)};
        }
        cellSpan_[c] = span;
    }
    loops_.clear();
    loopCorners_.clear();
    next_.assign(slotPoint_.size(), kNone);
    nextEdge_.resize(slotPoint_.size());
    addLyingFaces(polytope, out);
    for (std::uint32_t c = 0; c < cells; ++c) {
        if (cellSpan_[c].from < cellSpan_[c].to) traceCell(polytope, c);
    }
    placeLoops(out);
}

// Links the lines cut from the cell's 2-faces end to start, each in the direction that the 2-face has in this cell,
// and walks around.
void Slicer::traceCell(const Polytope& polytope, std::uint32_t cell) {
    const Span span = cellSpan_[cell];
    starts_.clear();
    for (std::uint32_t at = polytope.cells.begin[cell]; at < polytope.cells.begin[cell + 1]; ++at) {
        const std::uint32_t f = polytope.cells.items[at];
        const bool outward = polytope.cellSigns[at] > 0;
        for (std::uint32_t i = lineBegin_[f]; i < lineBegin_[f + 1]; ++i) {
            const Line& line = lines_[i];
            if (line.plane < span.from) continue;
            const std::uint32_t from = outward ? line.up : line.down;
            next_[from] = outward ? line.down : line.up;
            nextEdge_[from] = line.edge;
            starts_.emplace_back(line.plane, from);
        }
    }
    for (const auto& [plane, start] : starts_) {
        if (next_[start] == kNone) continue;
        Loop loop{plane, cell, static_cast<std::uint32_t>(loopCorners_.size()), 0};
        for (std::uint32_t slot = start; next_[slot] != kNone;) {
            if (nextEdge_[slot] != kNone) loopCorners_.push_back({slotPoint_[slot], nextEdge_[slot]});
            slot = std::exchange(next_[slot], kNone);
        }
        loop.size = static_cast<std::uint32_t>(loopCorners_.size()) - loop.begin;
        if (loop.size >= 3) {
            loops_.push_back(loop);
        } else {
            loopCorners_.resize(loop.begin);
        }
    }
}

// A 2-face in the hyperplane bounds the slice where a cell stands on it, or where it bounds a cell that lies in the
// hyperplane with the polytope under it: its loop runs as in that cell. One that the polytope merely touches is the
// whole slice.
void Slicer::addLyingFaces(const Polytope& polytope, const SliceSet& out) {
    touchingFaces_.clear();
    bounded_.assign(out.planes.count, false);
    for (std::uint32_t f = 0; f < polytope.faces.size(); ++f) {
        const std::int32_t plane = lyingIn_[f];
        if (plane == kNoPlane) continue;
        std::array<bool, 2> stands{};
        std::array<bool, 2> bounds{};
        std::array<bool, 2> outward{};
        for (std::size_t i = 0; i < 2; ++i) {
            const std::uint32_t cell = polytope.faceCells[f].at(i);
            const auto faces = polytope.cells[cell];
            const auto place = std::find(faces.begin(), faces.end(), f) - faces.begin();
            outward.at(i) = polytope.cellSigns[polytope.cells.begin[cell] + place] > 0;
            const Span span = cellSpan_[cell];
            stands.at(i) = span.from > plane && span.to > plane;
            bounds.at(i) = stands.at(i) || (span.from > plane && span.to <= plane && liesOnTop(polytope, cell, out));
        }
        if ((stands[0] && stands[1]) || (!bounds[0] && !bounds[1])) {
            touchingFaces_.push_back(f);
            continue;
        }
        for (std::size_t i = 0; i < 2; ++i) {
            if (bounds.at(i)) addLyingFace(polytope, f, outward.at(i));
        }
    }
    for (const std::uint32_t f : touchingFaces_) {
        bool alone = true;
        for (const std::uint32_t cell : polytope.faceCells[f]) {
            alone = alone && (cellSpan_[cell].from > lyingIn_[f] || cellSpan_[cell].to <= lyingIn_[f]);
        }
        if (alone && !bounded_[lyingIn_[f]]) addLyingFace(polytope, f, true);
    }
}

void Slicer::addLyingFace(const Polytope& polytope, std::uint32_t face, bool forward) {
    const auto loop = polytope.faces[face];
    const std::size_t n = loop.size();
    bounded_[lyingIn_[face]] = true;
    loops_.push_back({lyingIn_[face], static_cast<std::uint32_t>(polytope.cells.size()) + face,
                      static_cast<std::uint32_t>(loopCorners_.size()), static_cast<std::uint32_t>(n)});
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t corner = forward ? i : (n - i) % n;
        const std::size_t edge = forward ? i : n - 1 - i;
        loopCorners_.push_back({vertexPoint_[loop[corner]], edgeLine_[polytope.faceEdges[face][edge]]});
    }
}

// Of a cell in a hyperplane: the polytope is under it, and it looks out to larger w. Then its 2-faces, each in the
// direction that it has in this cell, enclose a positive volume.
bool Slicer::liesOnTop(const Polytope& polytope, std::uint32_t cell, const SliceSet& out) const {
    double volume = 0;
    for (std::uint32_t at = polytope.cells.begin[cell]; at < polytope.cells.begin[cell + 1]; ++at) {
        const auto loop = polytope.faces[polytope.cells.items[at]];
        const glm::dvec3 first(out.turned[loop[0]]);
        for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
            const glm::dvec3 normal = glm::cross(glm::dvec3(out.turned[loop[i]]), glm::dvec3(out.turned[loop[i + 1]]));
            volume += polytope.cellSigns[at] * glm::dot(first, normal);
        }
    }
    return volume > 0;
}

// Sorts the loops by hyperplane into the slice set.
void Slicer::placeLoops(SliceSet& out) {
    out.faceBegin.assign(out.planes.count + 1, 0);
    cornerCursor_.assign(out.planes.count + 1, 0);
    for (const Loop& loop : loops_) {
        countSpan(out.faceBegin, loop.plane, loop.plane + 1);
        cornerCursor_[loop.plane] += loop.size;
        cornerCursor_[loop.plane + 1] -= loop.size;
    }
    const std::uint32_t total = accumulate(out.faceBegin);
    const std::uint32_t corners = accumulate(cornerCursor_);
    out.faceOf.resize(total);
    out.cornerBegin.resize(total + 1);
    out.cornerBegin[total] = corners;
    out.corners.resize(corners);
    out.cornerEdges.resize(corners);
    cursor_.assign(out.faceBegin.begin(), out.faceBegin.end());
    for (const Loop& loop : loops_) {
        const std::uint32_t face = cursor_[loop.plane]++;
        std::uint32_t& corner = cornerCursor_[loop.plane];
        const std::uint32_t firstVertex = out.vertexBegin[loop.plane];
        const std::uint32_t firstEdge = out.edgeBegin[loop.plane];
        out.faceOf[face] = loop.of;
        out.cornerBegin[face] = corner;
        for (std::uint32_t i = loop.begin; i < loop.begin + loop.size; ++i, ++corner) {
            out.corners[corner] = loopCorners_[i][0] - firstVertex;
            out.cornerEdges[corner] = loopCorners_[i][1] - firstEdge;
        }
    }
}

}  // namespace oval4d::geometry
