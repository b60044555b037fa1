#include "geometry/slicer.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "geometry/ranges.hpp"

// Everything is cut just above each hyperplane, where no vertex lies in the way, and then let down onto it: a point
// cut from an edge that starts in the hyperplane falls onto that vertex, a line cut from a 2-face that stands on an
// edge falls onto that edge, and what shrinks to nothing is left out. So the degenerate positions need no cases of
// their own, and sections come out as closed loops even where 2-faces are stars.

namespace oval4d::geometry {

void Slicer::slice(const Polytope& polytope, const Rotation& orientation, const Hyperplanes& planes, SliceSet& out) {
    out.planes = planes;
    locateVertices(polytope, orientation, out);
    if (!polytope.convex || !cutConvex(polytope, out)) cutAny(polytope, out);
}

void Slicer::cutAny(const Polytope& polytope, SliceSet& out) {
    cutEdges(polytope, out);
    cutFaces(polytope, out);
    cutCells(polytope, out);
}

bool Slicer::cutConvex(const Polytope& polytope, SliceSet& out) {
    touching_.clear();
    if (anyLie_ && !cutTouching(polytope, out)) return false;
    return convexCut_.cut(polytope, {below_, upTo_, anyLie_}, touching_, out);
}

// Where the polytope touches a hyperplane from one side, that slice alone is cut the general way. False where
// hyperplanes are so near to one another that vertices lie in two.
bool Slicer::cutTouching(const Polytope& polytope, SliceSet& out) {
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
        cutOne(polytope, k, *touching_[k], out);
    }
    below_.swap(allBelow_);
    upTo_.swap(allUpTo_);
    return touched <= singles_.size();
}

void Slicer::cutOne(const Polytope& polytope, std::int32_t plane, SliceSet& single, SliceSet& all) {
    for (std::size_t v = 0; v < below_.size(); ++v) {
        below_[v] = std::clamp(allBelow_[v] - plane, 0, 1);
        upTo_[v] = std::clamp(allUpTo_[v] - plane, 0, 1);
    }
    single.planes = {all.planes.first + plane, 1, all.planes.spacing};
    single.turned.swap(all.turned);
    cutAny(polytope, single);
    single.turned.swap(all.turned);
}

void Slicer::locateVertices(const Polytope& polytope, const Rotation& orientation, SliceSet& out) {
    const auto count = static_cast<double>(out.planes.count);
    const double inverse = 1 / out.planes.spacing;
    const double tolerance = kOnPlane * polytope.circumradius * inverse;
    const glm::dmat4 m = orientation.matrix();
    const std::size_t n = polytope.vertices.size();
    out.turned.resize(n);
    below_.resize(n);
    upTo_.resize(n);
    anyLie_ = false;
    for (std::size_t v = 0; v < n; ++v) {
        out.turned[v] = m * polytope.vertices[v];
        const double level = out.turned[v].w * inverse - out.planes.first;
        const double above = std::clamp(level - tolerance, 0.0, count);
        const auto whole = static_cast<std::int32_t>(above);
        below_[v] = whole + (above > whole ? 1 : 0);  // rounded up
        upTo_[v] = static_cast<std::int32_t>(std::clamp(level + tolerance + 1, 0.0, count));
        anyLie_ |= below_[v] != upTo_[v];
    }
}

// Slice vertices: the polytope's vertices in the hyperplane, and the crossed edges.
void Slicer::cutEdges(const Polytope& polytope, SliceSet& out) {
    const auto edges = static_cast<std::uint32_t>(polytope.edges.size());
    const auto vertices = static_cast<std::uint32_t>(polytope.vertices.size());
    out.vertexBegin.assign(out.planes.count + 1, 0);
    for (std::uint32_t v = 0; v < vertices; ++v) {
        if (below_[v] != upTo_[v]) countSpan(out.vertexBegin, below_[v], upTo_[v]);
    }
    slotBegin_.resize(edges);
    std::uint32_t slots = 0;
    for (std::uint32_t e = 0; e < edges; ++e) {
        const auto [a, b] = polytope.edges[e];
        slotBegin_[e] = slots;
        slots += std::abs(below_[a] - below_[b]);
        const std::int32_t from = std::min(upTo_[a], upTo_[b]);
        const std::int32_t to = std::max(below_[a], below_[b]);
        if (from < to) countSpan(out.vertexBegin, from, to);
    }
    const std::uint32_t total = accumulate(out.vertexBegin);
    out.vertices.resize(total);
    out.vertexOf.resize(total);
    vertexPoint_.resize(vertices);
    slotPoint_.resize(slots);
    cursor_.assign(out.vertexBegin.begin(), out.vertexBegin.end());

    for (std::uint32_t v = 0; v < vertices; ++v) {
        if (below_[v] == upTo_[v]) continue;
        const std::uint32_t point = cursor_[below_[v]]++;
        vertexPoint_[v] = point;
        out.vertices[point] = out.turned[v];
        out.vertexOf[point] = edges + v;
    }
    std::uint32_t* slot = slotPoint_.data();
    for (std::uint32_t e = 0; e < edges; ++e) {
        auto [lower, upper] = polytope.edges[e];
        if (below_[lower] == below_[upper]) continue;
        if (below_[lower] > below_[upper]) std::swap(lower, upper);
        std::int32_t k = below_[lower];
        if (k < upTo_[lower]) {
            *slot++ = vertexPoint_[lower];
            ++k;
        }
        const glm::dvec4& a = out.turned[lower];
        const glm::dvec4 along = out.turned[upper] - a;
        const glm::dvec3 perRise = glm::dvec3(along) * (1 / along.w);
        for (; k < below_[upper]; ++k) {
            const std::uint32_t point = cursor_[k]++;
            *slot++ = point;
            out.vertices[point] = glm::dvec3(a) + (out.planes.w(k) - a.w) * perRise;
            out.vertexOf[point] = e;
        }
    }
}

// Slice edges: the polytope's edges in the hyperplane, and the crossed 2-faces.
void Slicer::cutFaces(const Polytope& polytope, SliceSet& out) {
    const auto faces = static_cast<std::uint32_t>(polytope.faces.size());
    twice_.resize(below_.size());
    for (std::size_t v = 0; v < below_.size(); ++v) twice_[v] = below_[v] + upTo_[v];
    up_.resize(out.planes.count);
    down_.resize(out.planes.count);
    faceSpan_.resize(faces);
    lyingIn_.resize(faces);
    lineBegin_.resize(faces + 1);
    lines_.clear();
    const std::uint32_t* vertex = polytope.faces.items.data();
    for (std::uint32_t f = 0; f < faces; ++f) {
        const std::uint32_t* end = polytope.faces.items.data() + polytope.faces.begin[f + 1];
        std::int32_t least = twice_[*vertex];
        std::int32_t most = least;
        while (++vertex != end) {
            least = std::min(least, twice_[*vertex]);
            most = std::max(most, twice_[*vertex]);
        }
        const Span above{least / 2, most / 2};
        const std::int32_t leastUpTo = (least + 1) / 2;
        const std::int32_t mostUpTo = (most + 1) / 2;
        faceSpan_[f] = {leastUpTo, above.to};
        lyingIn_[f] = above.from == above.to && leastUpTo == mostUpTo && leastUpTo > above.to ? above.to : kNoPlane;
        lineBegin_[f] = static_cast<std::uint32_t>(lines_.size());
        if (above.from == above.to) continue;
        if (polytope.convexFaces) {
            cutConvexFace(polytope, f, above);
        } else {
            cutAnyFace(polytope, f, above, out);
        }
    }
    lineBegin_[faces] = static_cast<std::uint32_t>(lines_.size());
    numberEdges(polytope, out);
}

// The loop of a convex 2-face goes up through a hyperplane once and comes down once.
void Slicer::cutConvexFace(const Polytope& polytope, std::uint32_t face, Span above) {
    const auto loop = polytope.faces[face];
    const auto loopEdges = polytope.faceEdges[face];
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const std::int32_t from = below_[loop[i]];
        const std::int32_t to = below_[loop[i + 1 == loop.size() ? 0 : i + 1]];
        std::uint32_t slot = slotBegin_[loopEdges[i]];
        if (from < to) {
            for (std::int32_t k = from; k < to; ++k) up_[k] = slot++;
        } else {
            for (std::int32_t k = to; k < from; ++k) down_[k] = slot++;
        }
    }
    for (std::int32_t k = above.from; k < above.to; ++k) addLine(polytope, face, k, up_[k], down_[k]);
}

// Any other loop crosses several times: along the line in which the hyperplane cuts the 2-face's plane, the i-th way
// up belongs to the i-th way down. Where pieces overlap the 2-face covers the line more than once.
void Slicer::cutAnyFace(const Polytope& polytope, std::uint32_t face, Span above, const SliceSet& out) {
    const auto loop = polytope.faces[face];
    const auto loopEdges = polytope.faceEdges[face];
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
            for (const Crossing& c : *crossings) {
                const glm::dvec3 d = out.vertices[slotPoint_[c.slot]] - origin;
                if (glm::dot(d, d) > glm::dot(direction, direction)) direction = d;
            }
        }
        for (auto* crossings : {&ups_, &downs_}) {
            for (Crossing& c : *crossings) c.along = glm::dot(out.vertices[slotPoint_[c.slot]] - origin, direction);
            std::sort(crossings->begin(), crossings->end(),
                      [](const Crossing& a, const Crossing& b) { return a.along < b.along; });
        }
        for (std::size_t i = 0; i < ups_.size(); ++i) addLine(polytope, face, k, ups_[i].slot, downs_[i].slot);
    }
}

void Slicer::addLine(const Polytope& polytope, std::uint32_t face, std::int32_t plane, std::uint32_t up,
                     std::uint32_t down) {
    std::uint32_t edge = kFresh;
    const std::uint32_t a = slotPoint_[up];
    const std::uint32_t b = slotPoint_[down];
    if (a == b) {
        edge = kNone;
    } else if (plane < faceSpan_[face].from) {
        // The 2-face only stands in this hyperplane: both points are vertices of it, and its edge between them lies
        // there.
        for (const std::uint32_t e : polytope.faceEdges[face]) {
            const auto [v, u] = polytope.edges[e];
            if (!liesInOne({v, u}) || below_[v] != plane) continue;
            if (std::minmax(vertexPoint_[v], vertexPoint_[u]) == std::minmax(a, b)) edge = e;
        }
    }
    lines_.push_back({plane, up, down, edge});
}

void Slicer::numberEdges(const Polytope& polytope, SliceSet& out) {
    const auto edges = static_cast<std::uint32_t>(polytope.edges.size());
    const auto faces = static_cast<std::uint32_t>(polytope.faces.size());
    out.edgeBegin.assign(out.planes.count + 1, 0);
    lyingEdges_.clear();
    for (std::uint32_t e = 0; e < edges; ++e) {
        if (!liesInOne(polytope.edges[e])) continue;
        lyingEdges_.push_back(e);
        const std::int32_t plane = below_[polytope.edges[e][0]];
        countSpan(out.edgeBegin, plane, plane + 1);
    }
    for (const Line& line : lines_) {
        if (line.edge == kFresh) countSpan(out.edgeBegin, line.plane, line.plane + 1);
    }
    const std::uint32_t total = accumulate(out.edgeBegin);
    out.edges.resize(total);
    out.edgeOf.resize(total);
    edgeLine_.resize(edges);
    cursor_.assign(out.edgeBegin.begin(), out.edgeBegin.end());
    const auto add = [&](std::int32_t plane, std::uint32_t a, std::uint32_t b, std::uint32_t of) {
        const std::uint32_t number = cursor_[plane]++;
        out.edges[number] = {a - out.vertexBegin[plane], b - out.vertexBegin[plane]};
        out.edgeOf[number] = of;
        return number;
    };
    for (const std::uint32_t e : lyingEdges_) {
        const auto [a, b] = polytope.edges[e];
        edgeLine_[e] = add(below_[a], vertexPoint_[a], vertexPoint_[b], faces + e);
    }
    for (std::uint32_t f = 0; f < faces; ++f) {
        for (std::uint32_t i = lineBegin_[f]; i < lineBegin_[f + 1]; ++i) {
            Line& line = lines_[i];
            if (line.edge == kNone) continue;
            line.edge = line.edge == kFresh ? add(line.plane, slotPoint_[line.up], slotPoint_[line.down], f)
                                            : edgeLine_[line.edge];
        }
    }
}

}  // namespace oval4d::geometry
