#include "geometry/convex_cut.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "geometry/ranges.hpp"
#include "geometry/slicer.hpp"

// Whether an element is cut is as good as random, and a branch on it costs more than the work that it saves: elements
// are listed without branches first, and the lists gone through.

namespace oval4d::geometry {

bool ConvexCut::cut(const Polytope& polytope, std::span<const std::int32_t> below, SliceSet& out) {
    levels_.resize(out.planes.count);
    for (int k = 0; k < out.planes.count; ++k) levels_[k] = out.planes.w(k);
    cutEdges(polytope, below, out);
    return cutFaces(polytope, below, out) && cutCells(polytope, out);
}

void ConvexCut::cutEdges(const Polytope& polytope, std::span<const std::int32_t> below, SliceSet& out) {
    const auto edges = static_cast<std::uint32_t>(polytope.edges.size());
    pointBegin_.resize(edges);
    crossedEdges_.resize(edges);
    std::uint32_t points = 0;
    std::size_t crossed = 0;
    for (std::uint32_t e = 0; e < edges; ++e) {
        const auto [a, b] = polytope.edges[e];
        const std::int32_t rise = std::abs(below[a] - below[b]);
        pointBegin_[e] = points;
        crossedEdges_[crossed] = e;
        crossed += rise != 0 ? 1 : 0;
        points += rise;
    }
    crossedEdges_.resize(crossed);
    out.vertexBegin.assign(out.planes.count + 1, 0);
    for (const std::uint32_t e : crossedEdges_) {
        const auto [from, to] = std::minmax(below[polytope.edges[e][0]], below[polytope.edges[e][1]]);
        countSpan(out.vertexBegin, from, to);
    }
    accumulate(out.vertexBegin);
    cursor_ = out.vertexBegin;
    out.vertices.resize(points);
    out.vertexOf.resize(points);
    point_.resize(points);
    for (const std::uint32_t e : crossedEdges_) {
        auto [lower, upper] = polytope.edges[e];
        if (below[lower] > below[upper]) std::swap(lower, upper);
        const glm::dvec4& a = out.turned[lower];
        const glm::dvec4 along = out.turned[upper] - a;
        const double perRise = 1 / along.w;
        std::uint32_t* point = &point_[pointBegin_[e]];
        for (std::int32_t k = below[lower]; k < below[upper]; ++k, ++point) {
            *point = cursor_[k]++;
            out.vertices[*point] = glm::dvec3(a) + (levels_[k] - a.w) * perRise * glm::dvec3(along);
            out.vertexOf[*point] = e;
        }
    }
}

bool ConvexCut::cutFaces(const Polytope& polytope, std::span<const std::int32_t> below, SliceSet& out) {
    const auto faces = static_cast<std::uint32_t>(polytope.faces.size());
    faceSpan_.resize(faces);
    lineBegin_.resize(faces);
    crossed_.resize(faces);
    std::uint32_t lines = 0;
    std::uint32_t crossings = 0;
    std::size_t crossed = 0;
    for (std::uint32_t f = 0; f < faces; ++f) {
        const auto loop = polytope.faces[f];
        std::int32_t here = below[loop.back()];
        Span span{here, here};
        for (const std::uint32_t v : loop) {
            crossings += std::abs(below[v] - here);
            here = below[v];
            span = {std::min(span.from, here), std::max(span.to, here)};
        }
        faceSpan_[f] = span;
        lineBegin_[f] = static_cast<std::int32_t>(lines) - span.from;
        crossed_[crossed] = f;
        crossed += span.from != span.to ? 1 : 0;
        lines += span.to - span.from;
    }
    if (crossings != 2 * lines) return false;
    crossed_.resize(crossed);
    out.edgeBegin.assign(out.planes.count + 1, 0);
    for (const std::uint32_t f : crossed_) countSpan(out.edgeBegin, faceSpan_[f].from, faceSpan_[f].to);
    accumulate(out.edgeBegin);
    cursor_ = out.edgeBegin;
    out.edges.resize(lines);
    out.edgeOf.resize(lines);
    lines_.resize(lines);
    findEnds(polytope, below);
    for (const std::uint32_t f : crossed_) {
        Line* line = lines_.data() + lineBegin_[f];
        for (std::int32_t k = faceSpan_[f].from; k < faceSpan_[f].to; ++k) {
            const std::uint32_t edge = cursor_[k]++;
            const std::uint32_t first = out.vertexBegin[k];
            line[k].edge = edge - out.edgeBegin[k];
            out.edges[edge] = {line[k].ends[0] - first, line[k].ends[1] - first};
            out.edgeOf[edge] = f;
        }
    }
    return true;
}

// The loop of a 2-face goes up through each hyperplane once and comes down once.
void ConvexCut::findEnds(const Polytope& polytope, std::span<const std::int32_t> below) {
    for (const std::uint32_t e : crossedEdges_) {
        const auto [from, to] = std::minmax(below[polytope.edges[e][0]], below[polytope.edges[e][1]]);
        const std::uint32_t falls = below[polytope.edges[e][0]] == from ? 0 : 1;
        const std::uint32_t* points = &point_[pointBegin_[e]];
        for (const std::uint32_t side : polytope.edgeFaces[e]) {
            const std::uint32_t comesDown = 1 ^ falls ^ (side & 1U);
            Line* line = lines_.data() + lineBegin_[side >> 1U];
            for (std::int32_t k = from; k < to; ++k) line[k].ends[comesDown] = points[k - from];
        }
    }
}

bool ConvexCut::cutCells(const Polytope& polytope, SliceSet& out) {
    const auto cells = static_cast<std::uint32_t>(polytope.cells.size());
    cellSpan_.resize(cells);
    crossed_.resize(cells);
    std::size_t crossed = 0;
    std::uint32_t total = 0;
    for (std::uint32_t c = 0; c < cells; ++c) {
        const auto faces = polytope.cells[c];
        Span span = faceSpan_[faces[0]];
        for (const std::uint32_t f : faces.subspan(1)) {
            span = {std::min(span.from, faceSpan_[f].from), std::max(span.to, faceSpan_[f].to)};
        }
        cellSpan_[c] = span;
        crossed_[crossed] = c;
        crossed += span.from != span.to ? 1 : 0;
        total += span.to - span.from;
    }
    crossed_.resize(crossed);
    out.faceBegin.assign(out.planes.count + 1, 0);
    for (const std::uint32_t c : crossed_) countSpan(out.faceBegin, cellSpan_[c].from, cellSpan_[c].to);
    accumulate(out.faceBegin);
    cursor_ = out.faceBegin;
    cornerCursor_.resize(out.planes.count);
    for (int k = 0; k < out.planes.count; ++k) cornerCursor_[k] = 2 * out.edgeBegin[k];  // an edge bounds two faces
    out.faceOf.resize(total);
    out.cornerBegin.resize(total + 1);
    out.cornerBegin[total] = 2 * out.edgeBegin.back();
    out.corners.resize(2 * lines_.size());
    out.cornerEdges.resize(2 * lines_.size());
    start_.resize(out.planes.count);
    steps_.resize(out.vertices.size());
    for (const std::uint32_t c : crossed_) {
        link(polytope, c);
        for (std::int32_t k = cellSpan_[c].from; k < cellSpan_[c].to; ++k) {
            const std::uint32_t first = out.vertexBegin[k];
            const std::uint32_t face = cursor_[k]++;
            std::uint32_t corner = cornerCursor_[k];
            out.faceOf[face] = c;
            out.cornerBegin[face] = corner;
            std::uint32_t vertex = start_[k];
            do {
                const Step step = steps_[vertex];
                out.corners[corner] = vertex - first;
                out.cornerEdges[corner++] = step.edge;
                vertex = step.to;
            } while (vertex != start_[k]);
            cornerCursor_[k] = corner;
        }
    }
    for (int k = 0; k < out.planes.count; ++k) {
        if (cornerCursor_[k] != 2 * out.edgeBegin[k + 1]) return false;
    }
    return true;
}

// The lines cut from the cell's 2-faces, end to start, each in the direction that the 2-face has in this cell. The
// sections begin with the first 2-face.
void ConvexCut::link(const Polytope& polytope, std::uint32_t cell) {
    for (std::uint32_t at = polytope.cells.begin[cell + 1]; at-- > polytope.cells.begin[cell];) {
        const std::uint32_t f = polytope.cells.items[at];
        const std::size_t outward = polytope.cellSigns[at] > 0 ? 1 : 0;
        const Line* line = lines_.data() + lineBegin_[f];
        for (std::int32_t k = faceSpan_[f].from; k < faceSpan_[f].to; ++k) {
            const std::uint32_t from = line[k].ends[1 - outward];
            steps_[from] = {line[k].ends[outward], line[k].edge};
            start_[k] = from;
        }
    }
}

}  // namespace oval4d::geometry
