#include "geometry/settling.hpp"

#include <algorithm>

namespace oval4d::geometry {

void Settling::begin(const Polytope& polytope, Levels levels) {
    levels_ = levels;
    ofVertex_.assign(polytope.vertices.size(), kNone);
    ofEdge_.assign(polytope.edges.size(), kNone);
}

SliceSize Settling::settle(const Polytope& polytope, int plane, SliceSize at, SliceSize size, SliceSet& out) {
    plane_ = plane;
    size.vertices = settleVertices(polytope, at, size.vertices, out);
    size.edges = settleEdges(polytope, at, size.edges, out);
    settleFaces(polytope, at, size, out);
    return size;
}

std::uint32_t Settling::settleVertices(const Polytope& polytope, SliceSize at, std::uint32_t count, SliceSet& out) {
    const auto edges = static_cast<std::uint32_t>(polytope.edges.size());
    auto* vertices = out.vertices.data() + at.vertices;
    auto* vertexOf = out.vertexOf.data() + at.vertices;
    vertex_.resize(count);
    std::uint32_t kept = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto [a, b] = polytope.edges[vertexOf[i]];
        const std::uint32_t lower = levels_.below[a] < levels_.below[b] ? a : b;
        if (!levels_.liesIn(lower, plane_)) {
            vertices[kept] = vertices[i];
            vertexOf[kept] = vertexOf[i];
            vertex_[i] = kept++;
            continue;
        }
        if (ofVertex_[lower] == kNone) {
            vertices[kept] = out.turned[lower];
            vertexOf[kept] = edges + lower;
            ofVertex_[lower] = kept++;
        }
        vertex_[i] = ofVertex_[lower];
    }
    return kept;
}

std::uint32_t Settling::settleEdges(const Polytope& polytope, SliceSize at, std::uint32_t count, SliceSet& out) {
    const auto faces = static_cast<std::uint32_t>(polytope.faces.size());
    const auto edges = static_cast<std::uint32_t>(polytope.edges.size());
    const auto* vertexOf = out.vertexOf.data() + at.vertices;
    auto* sliceEdges = out.edges.data() + at.edges;
    auto* edgeOf = out.edgeOf.data() + at.edges;
    edge_.resize(count);
    std::uint32_t kept = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t a = vertex_[sliceEdges[i][0]], b = vertex_[sliceEdges[i][1]];
        edge_[i] = kNone;
        if (a == b) continue;
        std::uint32_t of = edgeOf[i];
        if (vertexOf[a] >= edges && vertexOf[b] >= edges) {
            if (const std::uint32_t under = edgeUnder(polytope, of, {a, b}); under != kNone) {
                edge_[i] = ofEdge_[under];
                if (edge_[i] != kNone) continue;
                ofEdge_[under] = kept;
                of = faces + under;
            }
        }
        sliceEdges[kept] = {a, b};
        edgeOf[kept] = of;
        edge_[i] = kept++;
    }
    return kept;
}

void Settling::settleFaces(const Polytope& polytope, SliceSize at, SliceSize& size, SliceSet& out) const {
    const auto cells = static_cast<std::uint32_t>(polytope.cells.size());
    const auto edges = static_cast<std::uint32_t>(polytope.edges.size());
    const auto* vertexOf = out.vertexOf.data() + at.vertices;
    auto* faceOf = out.faceOf.data() + at.faces;
    auto* cornerBegin = out.cornerBegin.data() + at.faces;
    auto* corners = out.corners.data();
    auto* cornerEdges = out.cornerEdges.data();
    cornerBegin[size.faces] = at.corners + size.corners;
    std::uint32_t kept = 0;
    std::uint32_t to = at.corners;
    std::uint32_t from = to;
    for (std::uint32_t f = 0; f < size.faces; ++f) {
        const std::uint32_t begin = to;
        const std::uint32_t end = cornerBegin[f + 1];
        bool allLie = true;
        for (; from < end; ++from) {
            const std::uint32_t edge = edge_[cornerEdges[from]];
            if (edge == kNone) continue;
            corners[to] = vertex_[corners[from]];
            cornerEdges[to] = edge;
            allLie = allLie && vertexOf[corners[to]] >= edges;
            ++to;
        }
        if (to - begin < 3) {
            to = begin;
            continue;
        }
        const std::uint32_t under = allLie ? faceUnder(polytope, faceOf[f], to - begin) : kNone;
        cornerBegin[kept] = begin;
        faceOf[kept++] = under == kNone ? faceOf[f] : cells + under;
    }
    size.faces = kept;
    size.corners = to - at.corners;
}

// The edge that the 2-face stands on, between these two vertices of the slice; none where it stands on several that
// make one straight line.
std::uint32_t Settling::edgeUnder(const Polytope& polytope, std::uint32_t face,
                                  std::array<std::uint32_t, 2> ends) const {
    for (const std::uint32_t e : polytope.faceEdges[face]) {
        const auto [a, b] = polytope.edges[e];
        if (!levels_.liesIn(a, plane_) || !levels_.liesIn(b, plane_)) continue;
        if (std::minmax(ofVertex_[a], ofVertex_[b]) == std::minmax(ends[0], ends[1])) return e;
    }
    return kNone;
}

// The 2-face that the cell stands on, of so many corners; none where it stands on several that make one polygon.
std::uint32_t Settling::faceUnder(const Polytope& polytope, std::uint32_t cell, std::size_t corners) const {
    const auto lies = [&](std::uint32_t v) { return levels_.liesIn(v, plane_); };
    for (const std::uint32_t f : polytope.cells[cell]) {
        const auto loop = polytope.faces[f];
        if (loop.size() == corners && std::all_of(loop.begin(), loop.end(), lies)) return f;
    }
    return kNone;
}

}  // namespace oval4d::geometry
