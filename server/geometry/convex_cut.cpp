#include "geometry/convex_cut.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "geometry/ranges.hpp"
#include "geometry/slicer.hpp"

// Whether an element is cut is as good as random, and a branch on it costs more than the work that it saves: elements
// are listed without branches first, and the lists gone through. What is read in a loop that writes is copied out of
// its vector before: the compiler has to take every number that is written for one of those.

namespace oval4d::geometry {

bool ConvexCut::cut(const Polytope& polytope, std::span<const std::int32_t> below, std::span<SliceSet* const> exact,
                    SliceSet& out) {
    exact_ = exact;
    levels_.resize(out.planes.count);
    for (int k = 0; k < out.planes.count; ++k) levels_[k] = out.planes.w(k);
    cutEdges(polytope, below.data(), out);
    if (!cutFaces(polytope, below.data(), out) || !cutCells(polytope, out)) return false;
    out.vertices.resize(out.vertexBegin.back());
    out.vertexOf.resize(out.vertexBegin.back());
    out.edges.resize(out.edgeBegin.back());
    out.edgeOf.resize(out.edgeBegin.back());
    out.faceOf.resize(out.faceBegin.back());
    out.cornerBegin.resize(out.faceBegin.back() + 1);
    out.cornerBegin.back() = cornerBegin_.back();
    out.corners.resize(cornerBegin_.back());
    out.cornerEdges.resize(cornerBegin_.back());
    for (std::size_t k = 0; k < exact_.size(); ++k) {
        if (exact_[k] != nullptr) insert(k, *exact_[k], out);
    }
    return true;
}

template <typename Count>
void ConvexCut::layOut(std::vector<std::uint32_t>& begin, std::vector<std::uint32_t>& place, Count count) {
    if (exact_.empty()) {
        accumulate(begin);
        place = begin;
        return;
    }
    elsewhere_.resize(exact_.size());
    for (std::size_t k = 0; k < exact_.size(); ++k) {
        elsewhere_[k] = exact_[k] == nullptr ? kOwn : static_cast<std::uint32_t>(count(*exact_[k]));
    }
    accumulate(begin, elsewhere_, place);
}

void ConvexCut::insert(std::size_t plane, const SliceSet& slice, SliceSet& out) const {
    const auto copy = [](const auto& from, auto& to, std::size_t begin) {
        std::copy(from.begin(), from.end(), to.begin() + static_cast<std::ptrdiff_t>(begin));
    };
    copy(slice.vertices, out.vertices, out.vertexBegin[plane]);
    copy(slice.vertexOf, out.vertexOf, out.vertexBegin[plane]);
    copy(slice.edges, out.edges, out.edgeBegin[plane]);
    copy(slice.edgeOf, out.edgeOf, out.edgeBegin[plane]);
    copy(slice.faceOf, out.faceOf, out.faceBegin[plane]);
    const std::uint32_t begin = cornerBegin_[plane];
    copy(slice.corners, out.corners, begin);
    copy(slice.cornerEdges, out.cornerEdges, begin);
    for (std::size_t f = 0; f < slice.faceOf.size(); ++f) {
        out.cornerBegin[out.faceBegin[plane] + f] = begin + slice.cornerBegin[f];
    }
}

void ConvexCut::cutEdges(const Polytope& polytope, const std::int32_t* below, SliceSet& out) {
    const auto edges = static_cast<std::uint32_t>(polytope.edges.size());
    pointAt_.resize(edges);
    crossedEdges_.resize(edges);
    out.vertexBegin.assign(out.planes.count + 1, 0);
    crossings_ = 0;
    std::int32_t points = 0;
    std::size_t crossed = 0;
    for (std::uint32_t e = 0; e < edges; ++e) {
        const std::int32_t a = below[polytope.edges[e][0]], b = below[polytope.edges[e][1]];
        const std::int32_t from = std::min(a, b), to = std::max(a, b);
        countSpan(out.vertexBegin, from, to);
        pointAt_[e] = points - from;
        points += to - from;
        crossings_ += (to - from) * (polytope.edgeFaces.begin[e + 1] - polytope.edgeFaces.begin[e]);
        crossedEdges_[crossed] = e;
        crossed += from != to ? 1 : 0;
    }
    crossedEdges_.resize(crossed);
    layOut(out.vertexBegin, vertexPlace_, [](const SliceSet& slice) { return slice.vertices.size(); });
    cursor_ = vertexPlace_;
    out.vertices.resize(vertexPlace_.back());
    out.vertexOf.resize(vertexPlace_.back());
    points_.resize(points);
    const double* levels = levels_.data();
    const std::uint32_t* first = vertexPlace_.data();
    std::uint32_t* cursor = cursor_.data();
    glm::dvec3* vertices = out.vertices.data();
    std::uint32_t* vertexOf = out.vertexOf.data();
    for (const std::uint32_t e : crossedEdges_) {
        auto [lower, upper] = polytope.edges[e];
        if (below[lower] > below[upper]) std::swap(lower, upper);
        const glm::dvec4& a = out.turned[lower];
        const glm::dvec4 along = out.turned[upper] - a;
        const glm::dvec3 perRise = glm::dvec3(along) * (1 / along.w);
        std::uint32_t* point = points_.data() + pointAt_[e];
        const std::int32_t to = below[upper];
        for (std::int32_t k = below[lower]; k < to; ++k) {
            const std::uint32_t number = cursor[k]++;
            point[k] = number - first[k];
            vertices[number] = glm::dvec3(a) + (levels[k] - a.w) * perRise;
            vertexOf[number] = e;
        }
    }
    mostVertices_ = 0;
    for (int k = 0; k < out.planes.count; ++k) mostVertices_ = std::max(mostVertices_, cursor_[k] - vertexPlace_[k]);
}

bool ConvexCut::cutFaces(const Polytope& polytope, const std::int32_t* below, SliceSet& out) {
    const auto faces = static_cast<std::uint32_t>(polytope.faces.size());
    faceSpan_.resize(faces);
    lineAt_.resize(faces);
    crossed_.resize(faces);
    out.edgeBegin.assign(out.planes.count + 1, 0);
    std::int32_t lines = 0;
    std::size_t crossed = 0;
    const std::uint32_t* vertex = polytope.faces.items.data();
    for (std::uint32_t f = 0; f < faces; ++f) {
        const std::uint32_t* end = polytope.faces.items.data() + polytope.faces.begin[f + 1];
        std::int32_t from = below[*vertex], to = from;
        while (++vertex != end) {
            from = std::min(from, below[*vertex]);
            to = std::max(to, below[*vertex]);
        }
        countSpan(out.edgeBegin, from, to);
        faceSpan_[f] = {from, to};
        lineAt_[f] = lines - from;
        lines += to - from;
        crossed_[crossed] = f;
        crossed += from != to ? 1 : 0;
    }
    if (crossings_ != 2 * static_cast<std::uint32_t>(lines)) return false;
    crossed_.resize(crossed);
    cornerBegin_ = out.edgeBegin;
    for (std::uint32_t& difference : cornerBegin_) difference *= 2;  // an edge bounds two faces
    layOut(cornerBegin_, cornerPlace_, [](const SliceSet& slice) { return slice.corners.size(); });
    layOut(out.edgeBegin, edgePlace_, [](const SliceSet& slice) { return slice.edges.size(); });
    cursor_ = edgePlace_;
    out.edges.resize(edgePlace_.back());
    out.edgeOf.resize(edgePlace_.back());
    lines_.resize(lines);
    findEnds(polytope, below);
    const std::uint32_t* first = edgePlace_.data();
    std::uint32_t* cursor = cursor_.data();
    auto* sliceEdges = out.edges.data();
    std::uint32_t* edgeOf = out.edgeOf.data();
    for (const std::uint32_t f : crossed_) {
        const Span span = faceSpan_[f];
        Line* lineOf = lines_.data() + lineAt_[f];
        for (std::int32_t k = span.from; k < span.to; ++k) {
            Line& line = lineOf[k];
            const std::uint32_t edge = cursor[k]++;
            line[0].edge = line[1].edge = edge - first[k];
            sliceEdges[edge] = {line[0].vertex, line[1].vertex};
            edgeOf[edge] = f;
        }
    }
    return true;
}

// The loop of a 2-face goes up through each hyperplane once and comes down once.
void ConvexCut::findEnds(const Polytope& polytope, const std::int32_t* below) {
    Line* lines = lines_.data();
    for (const std::uint32_t e : crossedEdges_) {
        const std::int32_t a = below[polytope.edges[e][0]], b = below[polytope.edges[e][1]];
        const std::int32_t from = std::min(a, b), to = std::max(a, b);
        const std::uint32_t rises = a < b ? 1 : 0;
        const std::uint32_t* points = points_.data() + pointAt_[e];
        for (const std::uint32_t side : polytope.edgeFaces[e]) {
            const std::uint32_t comesDown = rises ^ (side & 1U);
            Line* line = lines + lineAt_[side >> 1U];
            for (std::int32_t k = from; k < to; ++k) line[k][comesDown].vertex = points[k];
        }
    }
}

bool ConvexCut::cutCells(const Polytope& polytope, SliceSet& out) {
    const auto cells = static_cast<std::uint32_t>(polytope.cells.size());
    cellSpan_.resize(cells);
    crossed_.resize(cells);
    out.faceBegin.assign(out.planes.count + 1, 0);
    std::size_t crossed = 0;
    const std::uint32_t* bound = polytope.cells.items.data();
    for (std::uint32_t c = 0; c < cells; ++c) {
        const std::uint32_t* end = polytope.cells.items.data() + polytope.cells.begin[c + 1];
        Span span = faceSpan_[*bound];
        while (++bound != end) {
            span = {std::min(span.from, faceSpan_[*bound].from), std::max(span.to, faceSpan_[*bound].to)};
        }
        countSpan(out.faceBegin, span.from, span.to);
        cellSpan_[c] = span;
        crossed_[crossed] = c;
        crossed += span.from != span.to ? 1 : 0;
    }
    crossed_.resize(crossed);
    layOut(out.faceBegin, facePlace_, [](const SliceSet& slice) { return slice.faceOf.size(); });
    cursor_ = facePlace_;
    cornerCursor_ = cornerPlace_;
    out.faceOf.resize(facePlace_.back());
    out.cornerBegin.resize(facePlace_.back() + 1);
    out.corners.resize(cornerPlace_.back());
    out.cornerEdges.resize(cornerPlace_.back());
    start_.resize(out.planes.count);
    steps_.resize(static_cast<std::size_t>(out.planes.count) * mostVertices_);
    std::uint32_t* cursor = cursor_.data();
    std::uint32_t* cornerCursor = cornerCursor_.data();
    const std::uint32_t* start = start_.data();
    std::uint32_t* faceOf = out.faceOf.data();
    std::uint32_t* cornerBegin = out.cornerBegin.data();
    for (const std::uint32_t c : crossed_) {
        link(polytope, c);
        const Span span = cellSpan_[c];
        for (std::int32_t k = span.from; k < span.to; ++k) {
            const std::uint32_t face = cursor[k]++;
            const std::uint32_t begin = cornerCursor[k];
            faceOf[face] = c;
            cornerBegin[face] = begin;
            const Step* steps = stepsOf(k);
            std::uint32_t* corner = out.corners.data() + begin;
            std::uint32_t* edge = out.cornerEdges.data() + begin;
            const std::uint32_t home = start[k];
            std::uint32_t vertex = home;
            do {
                const Step step = steps[vertex];
                *corner++ = vertex;
                *edge++ = step.edge;
                vertex = step.vertex;
            } while (vertex != home);
            cornerCursor[k] = static_cast<std::uint32_t>(corner - out.corners.data());
        }
    }
    for (int k = 0; k < out.planes.count; ++k) {
        if ((exact_.empty() || exact_[k] == nullptr) && cornerCursor_[k] != cornerBegin_[k + 1]) return false;
    }
    return true;
}

// The lines cut from the cell's 2-faces, end to start, each in the direction that the 2-face has in this cell. The
// sections begin with the first 2-face.
inline void ConvexCut::link(const Polytope& polytope, std::uint32_t cell) {
    std::uint32_t* start = start_.data();
    const std::size_t stride = mostVertices_;
    for (std::uint32_t at = polytope.cells.begin[cell + 1]; at-- > polytope.cells.begin[cell];) {
        const std::uint32_t f = polytope.cells.items[at];
        const std::size_t outward = polytope.cellSigns[at] > 0 ? 1 : 0;
        const Span span = faceSpan_[f];
        const Line* line = lines_.data() + lineAt_[f];
        Step* steps = stepsOf(span.from);
        for (std::int32_t k = span.from; k < span.to; ++k, steps += stride) {
            const std::uint32_t from = line[k][1 - outward].vertex;
            steps[from] = line[k][outward];
            start[k] = from;
        }
    }
}

}  // namespace oval4d::geometry
