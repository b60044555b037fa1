#include "slicing/sweep.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>

namespace oval4d::slicing {

namespace {

using SixteenByteChunk = std::array<std::byte, 16>;

void copyChunk(const std::byte* from, std::byte* to) {
    SixteenByteChunk chunk;
    std::memcpy(&chunk, from, sizeof chunk);
    std::memcpy(to, &chunk, sizeof chunk);
}

// Repeats the block of `size` items that begins at `begin`, so that it occurs `times` times in succession. Makes the
// first few copies of a small block inline, because a call of memcpy takes longer than copying a small block. After
// these copies, doubles the copied range with each call of memcpy.
template <typename Item>
void repeatBlock(std::vector<Item>& items, std::size_t begin, std::size_t size, std::size_t times) {
    constexpr std::size_t kSmall = 256, kFew = 8;
    auto* const first = reinterpret_cast<std::byte*>(items.data() + begin);
    const std::size_t bytes = size * sizeof(Item);
    std::size_t done = bytes;
    if (bytes >= sizeof(SixteenByteChunk) && bytes <= kSmall) {
        // The position of the last chunk in the block; this chunk may overlap the one before it.
        const std::size_t last = bytes - sizeof(SixteenByteChunk);
        for (; done < bytes * std::min(times, kFew); done += bytes) {
            for (std::size_t at = 0; at < last; at += sizeof(SixteenByteChunk))
                copyChunk(first + at, first + done + at);
            copyChunk(first + last, first + done + last);
        }
    }
    for (; done < bytes * times; done *= 2) std::memcpy(first + done, first, std::min(done, bytes * times - done));
}

// Copies the only slice of the set `slice` into `out`, from position `at` on. Returns the size of this slice.
SliceElementCounts copySlice(const SliceSet& slice, SliceElementCounts at, SliceSet& out) {
    const SliceElementCounts size = slice.totalCounts();
    const auto copy = [](const auto& from, auto& to, std::size_t begin) {
        std::copy(from.begin(), from.end(), to.begin() + static_cast<std::ptrdiff_t>(begin));
    };
    copy(slice.vertices, out.vertices, at.vertices);
    copy(slice.vertexSource, out.vertexSource, at.vertices);
    copy(slice.edges, out.edges, at.edges);
    copy(slice.edgeSource, out.edgeSource, at.edges);
    copy(slice.faceSource, out.faceSource, at.faces);
    copy(slice.corners, out.corners, at.corners);
    copy(slice.cornerEdges, out.cornerEdges, at.corners);
    copy(slice.cornerBegin, out.cornerBegin, at.faces);
    for (std::size_t f = 0; f < size.faces; ++f) out.cornerBegin[at.faces + f] += at.corners;
    return size;
}

}  // namespace

bool HyperplaneSweep::begin(const polytopes::Polytope& polytope, PlanesBelowVertices planesBelow, int planes) {
    planesBelow_ = planesBelow;
    findStructureChanges(polytope, planes);
    return tryFindCutElements(polytope, planes);
}

bool HyperplaneSweep::cut(const polytopes::Polytope& polytope, std::span<SliceSet* const> touching, int first,
                          SliceElementCounts& at, SliceSet& out) {
    first_ = first;
    // A local copy of `at`, because the compiler must assume that writes to the arrays may change `at` itself.
    SliceElementCounts here = at;
    for (std::size_t step = 0; step + 1 < structureChanges_.size(); ++step) {
        int k = structureChanges_[step];
        const int next = structureChanges_[step + 1];
        advanceTo(polytope, out.rotatedVertices, k);
        const SliceElementCounts size = countsOfSlice();
        if (verticesMet_[k] == VertexEncounter::inside) {
            out.setSliceBegin(first + k, here);
            if (!touching.empty() && touching[k] != nullptr) {
                here = here + copySlice(*touching[k], here, out);
            } else {
                if (!writeSlices(k, k + 1, here, out)) return false;
                here = here + collapse_.collapse(polytope, k, here, size, out);
            }
            ++k;
        }
        if (k < next && !writeSlices(k, next, here, out)) return false;
        for (; k < next; ++k, here = here + size) out.setSliceBegin(first + k, here);
    }
    at = here;
    return true;
}

// Finds the hyperplanes at which the set of cut elements may change: see structureChanges_.
void HyperplaneSweep::findStructureChanges(const polytopes::Polytope& polytope, int planes) {
    verticesMet_.assign(planes + 1, VertexEncounter::none);
    for (const std::int32_t below : planesBelow_.below) verticesMet_[below] = VertexEncounter::between;
    if (planesBelow_.anyOnPlane) {
        for (std::size_t v = 0; v < planesBelow_.below.size(); ++v) {
            if (planesBelow_.below[v] != planesBelow_.upTo[v])
                verticesMet_[planesBelow_.below[v]] = VertexEncounter::inside;
        }
        collapse_.begin(polytope, planesBelow_);
    }
    structureChanges_.assign(1, 0);
    for (int k = 1; k < planes; ++k) {
        if (verticesMet_[k] != VertexEncounter::none) structureChanges_.push_back(k);
    }
    structureChanges_.push_back(planes);
}

// Finds the range of hyperplanes that cut each element, and the total size of the slices. Returns false if a hyperplane
// cuts a 2-face in several segments.
bool HyperplaneSweep::tryFindCutElements(const polytopes::Polytope& polytope, int planes) {
    const std::int32_t* below = planesBelow_.below.data();
    const auto edges = static_cast<std::uint32_t>(polytope.edges.size());
    const auto faces = static_cast<std::uint32_t>(polytope.faces.size());
    const auto cells = static_cast<std::uint32_t>(polytope.cells.size());
    SliceElementCounts total;
    std::uint32_t ends = 0;
    edges_.clear(edges, planes);
    for (std::uint32_t e = 0; e < edges; ++e) {
        const std::int32_t a = below[polytope.edges[e][0]], b = below[polytope.edges[e][1]];
        // `to` is the maximum of a and b, computed without a branch
        const std::int32_t from = std::min(a, b), to = a + b - from;
        total.vertices += to - from;
        ends += (to - from) * (polytope.edgeFaces.begin[e + 1] - polytope.edgeFaces.begin[e]);
        edges_.add(e, from, to);
    }
    edges_.sortByFirstHyperplane(structureChanges_);

    faces_.clear(faces, planes);
    faceSpan_.resize(faces);
    const std::uint32_t* vertex = polytope.faces.items.data();
    for (std::uint32_t f = 0; f < faces; ++f) {
        const std::uint32_t* end = polytope.faces.items.data() + polytope.faces.begin[f + 1];
        std::int32_t from = below[*vertex], to = from;
        while (++vertex != end) {
            from = std::min(from, below[*vertex]);
            to = std::max(to, below[*vertex]);
        }
        faceSpan_[f] = {from, to};
        total.edges += to - from;
        faces_.add(f, from, to);
    }
    if (ends != 2 * total.edges) return false;
    faces_.sortByFirstHyperplane(structureChanges_);
    total.corners = 2 * total.edges;  // every slice edge bounds two faces

    cells_.clear(cells, planes);
    const std::uint32_t* bound = polytope.cells.items.data();
    for (std::uint32_t c = 0; c < cells; ++c) {
        const std::uint32_t* end = polytope.cells.items.data() + polytope.cells.begin[c + 1];
        HyperplaneRange span = faceSpan_[*bound];
        while (++bound != end) {
            span.from = std::min(span.from, faceSpan_[*bound].from);
            span.to = std::max(span.to, faceSpan_[*bound].to);
        }
        total.faces += span.to - span.from;
        cells_.add(c, span.from, span.to);
    }
    cells_.sortByFirstHyperplane(structureChanges_);

    line_.resize(edges);
    vertex_.resize(edges);
    sliceEdge_.resize(faces);
    edgeOfEnd_.resize(2 * std::size_t{faces});
    nextEnd_.resize(2 * std::size_t{faces});
    firstEnd_.resize(cells);
    size_ = total;
    return true;
}

void HyperplaneSweep::advanceTo(const polytopes::Polytope& polytope, const std::vector<glm::dvec4>& rotatedVertices,
                                int plane) {
    for (const ActiveElementList::CutElement& edge : edges_.advanceTo(plane))
        beginEdge(polytope, edge.number, rotatedVertices);
    faces_.advanceTo(plane);
    cells_.advanceTo(plane);
}

// Makes an edge active: computes the line through the edge, and links the half-edges that meet on the edge (see
// edgeOfEnd_).
inline void HyperplaneSweep::beginEdge(const polytopes::Polytope& polytope, std::uint32_t e,
                                       const std::vector<glm::dvec4>& rotatedVertices) {
    const std::int32_t* below = planesBelow_.below.data();
    const auto& edge = polytope.edges[e];
    const std::uint32_t rises = below[edge[0]] < below[edge[1]] ? 1 : 0;
    const glm::dvec4& at = rotatedVertices[edge[1 - rises]];
    const glm::dvec4 along = rotatedVertices[edge[rises]] - at;
    EdgeLine& line = line_[e];
    line.at = at;
    line.slope = glm::dvec3(along) * (1 / along.w);
    const auto around = polytope.edgeFaces[e];
    std::uint32_t last = around.back() ^ rises;
    for (const std::uint32_t side : around) {
        const std::uint32_t here = side ^ rises;
        const std::uint32_t out = rises != 0 ? last : here, into = rises != 0 ? here : last;
        edgeOfEnd_[here] = e;
        nextEnd_[out] = into ^ 1U;
        firstEnd_[polytope.faceCells[here >> 1U][here & 1U]] = here;
        last = here;
    }
}

// Writes the slices in the hyperplanes with the indices plane … end − 1. No vertex lies between these hyperplanes, so
// their slices differ only in the coordinates of their vertices. Returns false if a hyperplane cuts a cell in several
// polygons.
bool HyperplaneSweep::writeSlices(int plane, int end, SliceElementCounts at, SliceSet& out) {
    writeVertices(plane, end, at, out);
    writeEdges(at, out);
    if (!writeFaces(at, out)) return false;
    const auto times = static_cast<std::size_t>(end - plane);
    if (times == 1) return true;
    const SliceElementCounts size = countsOfSlice();
    repeatBlock(out.vertexSource, at.vertices, size.vertices, times);
    repeatBlock(out.edges, at.edges, size.edges, times);
    repeatBlock(out.edgeSource, at.edges, size.edges, times);
    repeatBlock(out.faceSource, at.faces, size.faces, times);
    repeatBlock(out.corners, at.corners, size.corners, times);
    repeatBlock(out.cornerEdges, at.corners, size.corners, times);
    std::uint32_t* begin = out.cornerBegin.data() + at.faces;
    for (std::size_t f = size.faces; f < size.faces * times; ++f) begin[f] = begin[f - size.faces] + size.corners;
    return true;
}

void HyperplaneSweep::writeVertices(int plane, int end, SliceElementCounts at, SliceSet& out) {
    const auto cut = edges_.activeElements();
    const EdgeLine* edgeLines = line_.data();
    std::uint32_t* vertexSource = out.vertexSource.data() + at.vertices;
    for (std::uint32_t i = 0; i < cut.size(); ++i) {
        vertexSource[i] = cut[i].number;
        vertex_[cut[i].number] = i;
    }
    glm::dvec3* vertex = out.vertices.data() + at.vertices;
    for (int k = plane; k < end; ++k) {
        const double w = out.planes.w(first_ + k);
        for (const ActiveElementList::CutElement& edge : cut) {
            const EdgeLine& line = edgeLines[edge.number];
            *vertex++ = glm::dvec3(line.at) + (w - line.at.w) * line.slope;
        }
    }
}

void HyperplaneSweep::writeEdges(SliceElementCounts at, SliceSet& out) {
    const auto cut = faces_.activeElements();
    const std::uint32_t* vertices = vertex_.data();
    const std::uint32_t* ends = edgeOfEnd_.data();
    auto* edges = out.edges.data() + at.edges;
    std::uint32_t* edgeSource = out.edgeSource.data() + at.edges;
    std::uint32_t* sliceEdges = sliceEdge_.data();
    for (std::uint32_t i = 0; i < cut.size(); ++i) {
        const std::uint32_t f = cut[i].number;
        edges[i] = {vertices[ends[2 * f]], vertices[ends[2 * f + 1]]};
        edgeSource[i] = f;
        sliceEdges[f] = i;
    }
}

bool HyperplaneSweep::writeFaces(SliceElementCounts at, SliceSet& out) const {
    const auto cut = cells_.activeElements();
    const std::uint32_t* sliceEdges = sliceEdge_.data();
    const std::uint32_t* next = nextEnd_.data();
    const auto* edges = out.edges.data() + at.edges;
    const std::uint32_t* edgeSource = out.edgeSource.data() + at.edges;
    std::uint32_t* faceSource = out.faceSource.data() + at.faces;
    std::uint32_t* cornerBegin = out.cornerBegin.data() + at.faces;
    std::uint32_t* corners = out.corners.data();
    std::uint32_t* cornerEdges = out.cornerEdges.data();
    std::uint32_t corner = at.corners;
    const std::uint32_t last = corner + 2 * faces_.size();
    for (std::size_t i = 0; i < cut.size(); ++i) {
        faceSource[i] = cut[i].number;
        cornerBegin[i] = corner;
        const std::uint32_t start = firstEnd_[cut[i].number];
        const std::uint32_t first = sliceEdges[start >> 1U];
        // The half-edge `start` ends on that edge of the cell that became active last. In a convex cell, the hyperplane
        // cuts this edge as long as it cuts the cell. If the hyperplane does not cut the 2-face of `start`, rounding
        // errors have made the cell nonconvex.
        if (first >= faces_.size() || edgeSource[first] != start >> 1U) return false;
        std::uint32_t end = start;
        do {
            if (corner == last) return false;
            const std::uint32_t edge = sliceEdges[end >> 1U];
            corners[corner] = edges[edge][1 - (end & 1U)];
            cornerEdges[corner] = edge;
            ++corner;
            end = next[end];
        } while (end != start);
    }
    return corner == last;
}

}  // namespace oval4d::slicing
