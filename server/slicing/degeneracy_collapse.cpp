#include "slicing/degeneracy_collapse.hpp"

#include <algorithm>

namespace oval4d::slicing {

void DegeneracyCollapse::begin(const polytopes::Polytope& polytope, PlanesBelowVertices planesBelow) {
    planesBelow_ = planesBelow;
    sliceVertex_.assign(polytope.vertices.size(), kNone);
    sliceEdge_.assign(polytope.edges.size(), kNone);
}

SliceElementCounts DegeneracyCollapse::collapse(const polytopes::Polytope& polytope, int plane, SliceElementCounts at,
                                                SliceElementCounts size, SliceSet& out) {
    plane_ = plane;
    size.vertices = collapseVertices(polytope, at, size.vertices, out);
    size.edges = collapseEdges(polytope, at, size.edges, out);
    collapseFaces(polytope, at, size, out);
    return size;
}

std::uint32_t DegeneracyCollapse::collapseVertices(const polytopes::Polytope& polytope, SliceElementCounts at,
                                                   std::uint32_t count, SliceSet& out) {
    const auto edges = static_cast<std::uint32_t>(polytope.edges.size());
    auto* vertices = out.vertices.data() + at.vertices;
    auto* vertexSource = out.vertexSource.data() + at.vertices;
    newVertex_.resize(count);
    std::uint32_t kept = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto [a, b] = polytope.edges[vertexSource[i]];
        const std::uint32_t lower = planesBelow_.below[a] < planesBelow_.below[b] ? a : b;
        if (!planesBelow_.liesIn(lower, plane_)) {
            vertices[kept] = vertices[i];
            vertexSource[kept] = vertexSource[i];
            newVertex_[i] = kept++;
            continue;
        }
        if (sliceVertex_[lower] == kNone) {
            vertices[kept] = out.rotatedVertices[lower];
            vertexSource[kept] = edges + lower;
            sliceVertex_[lower] = kept++;
        }
        newVertex_[i] = sliceVertex_[lower];
    }
    return kept;
}

std::uint32_t DegeneracyCollapse::collapseEdges(const polytopes::Polytope& polytope, SliceElementCounts at,
                                                std::uint32_t count, SliceSet& out) {
    const auto faces = static_cast<std::uint32_t>(polytope.faces.size());
    const auto edges = static_cast<std::uint32_t>(polytope.edges.size());
    const auto* vertexSource = out.vertexSource.data() + at.vertices;
    auto* sliceEdges = out.edges.data() + at.edges;
    auto* edgeSource = out.edgeSource.data() + at.edges;
    newEdge_.resize(count);
    std::uint32_t kept = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t a = newVertex_[sliceEdges[i][0]], b = newVertex_[sliceEdges[i][1]];
        newEdge_[i] = kNone;
        if (a == b) continue;
        std::uint32_t source = edgeSource[i];
        if (vertexSource[a] >= edges && vertexSource[b] >= edges) {
            if (const std::uint32_t base = edgeInHyperplane(polytope, source, {a, b}); base != kNone) {
                newEdge_[i] = sliceEdge_[base];
                if (newEdge_[i] != kNone) continue;
                sliceEdge_[base] = kept;
                source = faces + base;
            }
        }
        sliceEdges[kept] = {a, b};
        edgeSource[kept] = source;
        newEdge_[i] = kept++;
    }
    return kept;
}

void DegeneracyCollapse::collapseFaces(const polytopes::Polytope& polytope, SliceElementCounts at,
                                       SliceElementCounts& size, SliceSet& out) {
    const auto cells = static_cast<std::uint32_t>(polytope.cells.size());
    const auto edges = static_cast<std::uint32_t>(polytope.edges.size());
    const auto* vertexSource = out.vertexSource.data() + at.vertices;
    auto* faceSource = out.faceSource.data() + at.faces;
    auto* cornerBegin = out.cornerBegin.data() + at.faces;
    auto* corners = out.corners.data();
    auto* cornerEdges = out.cornerEdges.data();
    cornerBegin[size.faces] = at.corners + size.corners;
    coinciding_.begin(size.edges);
    std::uint32_t kept = 0;
    std::uint32_t to = at.corners;
    std::uint32_t from = to;
    for (std::uint32_t f = 0; f < size.faces; ++f) {
        const std::uint32_t begin = to;
        const std::uint32_t end = cornerBegin[f + 1];
        bool allLie = true;
        for (; from < end; ++from) {
            const std::uint32_t edge = newEdge_[cornerEdges[from]];
            if (edge == kNone) continue;
            corners[to] = newVertex_[corners[from]];
            cornerEdges[to] = edge;
            allLie = allLie && vertexSource[corners[to]] >= edges;
            ++to;
        }
        if (to - begin < 3) {
            if (to - begin == 2) coinciding_.markCoinciding(cornerEdges[begin], cornerEdges[begin + 1]);
            to = begin;
            continue;
        }
        const std::uint32_t base = allLie ? faceInHyperplane(polytope, faceSource[f], to - begin) : kNone;
        cornerBegin[kept] = begin;
        faceSource[kept++] = base == kNone ? faceSource[f] : cells + base;
    }
    size.faces = kept;
    size.corners = to - at.corners;
    if (coinciding_.anyCoincide()) removeCoincidingEdges(at, size, out);
}

void DegeneracyCollapse::removeCoincidingEdges(SliceElementCounts at, SliceElementCounts& size, SliceSet& out) {
    auto* sliceEdges = out.edges.data() + at.edges;
    auto* edgeSource = out.edgeSource.data() + at.edges;
    newEdge_.resize(size.edges);
    std::uint32_t kept = 0;
    for (std::uint32_t i = 0; i < size.edges; ++i) {
        if (const std::uint32_t first = coinciding_.representativeOf(i); first != i) {
            newEdge_[i] = newEdge_[first];
            continue;
        }
        sliceEdges[kept] = sliceEdges[i];
        edgeSource[kept] = edgeSource[i];
        newEdge_[i] = kept++;
    }
    size.edges = kept;
    for (std::uint32_t i = at.corners; i < at.corners + size.corners; ++i)
        out.cornerEdges[i] = newEdge_[out.cornerEdges[i]];
}

// Returns the edge of the 2-face `face` that lies in the hyperplane and joins the two slice vertices `ends`. Returns
// kNone if there is no such edge, for example because several collinear edges lie between the two vertices.
std::uint32_t DegeneracyCollapse::edgeInHyperplane(const polytopes::Polytope& polytope, std::uint32_t face,
                                                   std::array<std::uint32_t, 2> ends) const {
    for (const std::uint32_t e : polytope.faceEdges[face]) {
        const auto [a, b] = polytope.edges[e];
        if (!planesBelow_.liesIn(a, plane_) || !planesBelow_.liesIn(b, plane_)) continue;
        if (std::minmax(sliceVertex_[a], sliceVertex_[b]) == std::minmax(ends[0], ends[1])) return e;
    }
    return kNone;
}

// Returns the 2-face of the cell `cell` that lies in the hyperplane and has `corners` corners. Returns kNone if there
// is no such 2-face, for example because the slice face consists of several coplanar 2-faces.
std::uint32_t DegeneracyCollapse::faceInHyperplane(const polytopes::Polytope& polytope, std::uint32_t cell,
                                                   std::size_t corners) const {
    const auto lies = [&](std::uint32_t v) { return planesBelow_.liesIn(v, plane_); };
    for (const std::uint32_t f : polytope.cells[cell]) {
        const auto loop = polytope.faces[f];
        if (loop.size() == corners && std::all_of(loop.begin(), loop.end(), lies)) return f;
    }
    return kNone;
}

}  // namespace oval4d::slicing
