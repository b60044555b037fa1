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
    const std::size_t most = std::max({polytope.edges.size(), polytope.faces.size(), below.size()});
    if (most > kMost || out.planes.count > static_cast<int>(kMost)) return false;
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
    crossedEdges_.resize(edges);
    out.vertexBegin.assign(out.planes.count + 1, 0);
    crossings_ = 0;
    std::uint32_t points = 0;
    std::size_t crossed = 0;
    for (std::uint32_t e = 0; e < edges; ++e) {
        const std::int32_t a = below[polytope.edges[e][0]], b = below[polytope.edges[e][1]];
        const std::int32_t from = std::min(a, b), to = std::max(a, b);
        countSpan(out.vertexBegin, from, to);
        points += to - from;
        crossings_ += (to - from) * (polytope.edgeFaces.begin[e + 1] - polytope.edgeFaces.begin[e]);
        crossedEdges_[crossed] = {e, a < b ? 1U : 0U, static_cast<Small>(from), static_cast<Small>(to)};
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
    Small* point = points_.data();
    for (const CrossedEdge crossing : crossedEdges_) {
        const auto& edge = polytope.edges[crossing.edge];
        const glm::dvec4& a = out.turned[edge[1 - crossing.rises]];
        const glm::dvec4 along = out.turned[edge[crossing.rises]] - a;
        const glm::dvec3 perRise = glm::dvec3(along) * (1 / along.w);
        for (std::int32_t k = crossing.from; k < crossing.to; ++k) {
            const std::uint32_t number = cursor[k]++;
            *point++ = static_cast<Small>(number - first[k]);
            vertices[number] = glm::dvec3(a) + (levels[k] - a.w) * perRise;
            vertexOf[number] = crossing.edge;
        }
    }
    mostVertices_ = 0;
    for (int k = 0; k < out.planes.count; ++k) mostVertices_ = std::max(mostVertices_, cursor_[k] - vertexPlace_[k]);
}

bool ConvexCut::cutFaces(const Polytope& polytope, const std::int32_t* below, SliceSet& out) {
    const auto faces = static_cast<std::uint32_t>(polytope.faces.size());
    faceSpan_.resize(faces);
    crossedFaces_.resize(faces);
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
        faceSpan_[f] = {lines - from, static_cast<Small>(from), static_cast<Small>(to)};
        lines += to - from;
        crossedFaces_[crossed] = f;
        crossed += from != to ? 1 : 0;
    }
    if (crossings_ != 2 * static_cast<std::uint32_t>(lines)) return false;
    crossedFaces_.resize(crossed);
    cornerBegin_ = out.edgeBegin;
    for (std::uint32_t& difference : cornerBegin_) difference *= 2;  // an edge bounds two faces
    layOut(cornerBegin_, cornerPlace_, [](const SliceSet& slice) { return slice.corners.size(); });
    layOut(out.edgeBegin, edgePlace_, [](const SliceSet& slice) { return slice.edges.size(); });
    cursor_ = edgePlace_;
    out.edges.resize(edgePlace_.back());
    out.edgeOf.resize(edgePlace_.back());
    lines_.resize(lines);
    findEnds(polytope);
    const std::uint32_t* first = edgePlace_.data();
    std::uint32_t* cursor = cursor_.data();
    auto* sliceEdges = out.edges.data();
    std::uint32_t* edgeOf = out.edgeOf.data();
    for (const std::uint32_t f : crossedFaces_) {
        const FaceSpan span = faceSpan_[f];
        Line* lineOf = lines_.data() + span.at;
        for (std::int32_t k = span.from; k < span.to; ++k) {
            const std::uint32_t edge = cursor[k]++;
            const auto number = static_cast<Small>(edge - first[k]);
            Line& line = lineOf[k];
            line[0].edge = number;
            line[1].edge = number;
            sliceEdges[edge] = {line[0].vertex, line[1].vertex};
            edgeOf[edge] = f;
        }
    }
    return true;
}

// The loop of a 2-face goes up through each hyperplane once and comes down once.
void ConvexCut::findEnds(const Polytope& polytope) {
    Line* lines = lines_.data();
    const FaceSpan* spans = faceSpan_.data();
    const Small* points = points_.data();
    for (const CrossedEdge edge : crossedEdges_) {
        points -= edge.from;
        for (const std::uint32_t side : polytope.edgeFaces[edge.edge]) {
            const std::uint32_t comesDown = edge.rises ^ (side & 1U);
            Line* line = lines + spans[side >> 1U].at;
            for (std::int32_t k = edge.from; k < edge.to; ++k) line[k][comesDown].vertex = points[k];
        }
        points += edge.to;
    }
}

bool ConvexCut::cutCells(const Polytope& polytope, SliceSet& out) {
    const auto cells = static_cast<std::uint32_t>(polytope.cells.size());
    crossedCells_.resize(cells);
    out.faceBegin.assign(out.planes.count + 1, 0);
    std::size_t crossed = 0;
    const std::uint32_t* bound = polytope.cells.items.data();
    for (std::uint32_t c = 0; c < cells; ++c) {
        const std::uint32_t* end = polytope.cells.items.data() + polytope.cells.begin[c + 1];
        Small from = faceSpan_[*bound].from, to = faceSpan_[*bound].to;
        while (++bound != end) {
            from = std::min(from, faceSpan_[*bound].from);
            to = std::max(to, faceSpan_[*bound].to);
        }
        countSpan(out.faceBegin, from, to);
        crossedCells_[crossed] = {c, from, to};
        crossed += from != to ? 1 : 0;
    }
    crossedCells_.resize(crossed);
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
    const Small* start = start_.data();
    std::uint32_t* faceOf = out.faceOf.data();
    std::uint32_t* cornerBegin = out.cornerBegin.data();
    for (const CrossedCell crossing : crossedCells_) {
        link(polytope, crossing.cell);
        const Step* steps = stepsOf(crossing.from);
        for (std::int32_t k = crossing.from; k < crossing.to; ++k, steps += mostVertices_) {
            const std::uint32_t face = cursor[k]++;
            const std::uint32_t begin = cornerCursor[k];
            faceOf[face] = crossing.cell;
            cornerBegin[face] = begin;
            std::uint32_t* corner = out.corners.data() + begin;
            std::uint32_t* edge = out.cornerEdges.data() + begin;
            const Small home = start[k];
            Small vertex = home;
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
    Small* start = start_.data();
    const std::size_t stride = mostVertices_;
    for (std::uint32_t at = polytope.cells.begin[cell + 1]; at-- > polytope.cells.begin[cell];) {
        const std::size_t outward = polytope.cellSigns[at] > 0 ? 1 : 0;
        const FaceSpan span = faceSpan_[polytope.cells.items[at]];
        const Line* line = lines_.data() + span.at;
        Step* steps = stepsOf(span.from);
        for (std::int32_t k = span.from; k < span.to; ++k, steps += stride) {
            const Small from = line[k][1 - outward].vertex;
            steps[from] = line[k][outward];
            start[k] = from;
        }
    }
}

}  // namespace oval4d::geometry
