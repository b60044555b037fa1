#pragma once
// Expectations that every slice of a convex polytope must meet.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <ostream>
#include <set>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "slicing/slice_set.hpp"
#include "unit/slicing/support.hpp"

namespace oval4d::support {

struct ElementsOfSlice {
    std::size_t vertices, edges, faces;
    bool operator==(const ElementsOfSlice&) const = default;
};
inline std::ostream& operator<<(std::ostream& os, const ElementsOfSlice& c) {
    return os << c.vertices << '/' << c.edges << '/' << c.faces;
}
inline ElementsOfSlice sliceCounts(const slicing::SliceSet& s, int i = 0) {
    return {s.vertexCount(i), s.edgeCount(i), s.faceCount(i)};
}

/// Expects that the loops of the slices' faces are closed, and traverse every slice edge as often in one direction as
/// in the other.
inline void expectClosed(const slicing::SliceSet& s) {
    for (int slice = 0; slice < s.planes.count; ++slice) {
        std::map<std::uint32_t, int> passes;
        for (auto f = s.faceBegin[slice]; f < s.faceBegin[slice + 1]; ++f) {
            const auto begin = s.cornerBegin[f];
            const auto end = s.cornerBegin[f + 1];
            for (auto i = begin; i < end; ++i) {
                const auto next = s.corners[i + 1 == end ? begin : i + 1];
                const auto& edge = s.edges[s.edgeBegin[slice] + s.cornerEdges[i]];
                const bool along = edge[0] == s.corners[i] && edge[1] == next;
                ASSERT_TRUE(along || (edge[1] == s.corners[i] && edge[0] == next));
                passes[s.cornerEdges[i]] += along ? 1 : -1;
            }
        }
        for (const auto& [edge, sum] : passes) ASSERT_EQ(sum, 0);
    }
}

/// Expects that slice number `slice` is a closed convex polyhedron with a positive volume and correct incidences. A
/// vertex may lie beyond the plane of a face by at most `slack`.
inline void expectClosedConvexSolid(const slicing::SliceSet& s, int slice, double slack = 1e-8) {
    const ElementsOfSlice c = sliceCounts(s, slice);
    ASSERT_EQ(c.vertices + c.faces, c.edges + 2) << c;
    glm::dvec3 center(0);
    for (auto v = s.vertexBegin[slice]; v < s.vertexBegin[slice + 1]; ++v) center += s.vertices[v] / double(c.vertices);
    std::map<std::uint32_t, int> passes;
    std::size_t sides = 0;
    for (auto f = s.faceBegin[slice]; f < s.faceBegin[slice + 1]; ++f) {
        const auto begin = s.cornerBegin[f];
        const auto end = s.cornerBegin[f + 1];
        ASSERT_GE(end - begin, 3U);
        glm::dvec3 normal(0);
        for (auto i = begin; i < end; ++i) {
            const auto next = i + 1 == end ? begin : i + 1;
            const auto& edge = s.edges[s.edgeBegin[slice] + s.cornerEdges[i]];
            ASSERT_EQ(std::set({edge[0], edge[1]}), std::set({s.corners[i], s.corners[next]}));
            ASSERT_NE(edge[0], edge[1]);
            passes[s.cornerEdges[i]] += edge[0] == s.corners[i] ? 1 : -1;
            ++sides;
            normal += glm::cross(corner(s, slice, i) - center, corner(s, slice, next) - center);
        }
        // The normal of the face must point outward, and no vertex of the slice may lie beyond the plane of the face.
        const double size = glm::length(normal);
        if (size < 1e-9) continue;
        ASSERT_GT(glm::dot(normal, corner(s, slice, begin) - center), 0);
        for (auto v = s.vertexBegin[slice]; v < s.vertexBegin[slice + 1]; ++v) {
            ASSERT_LT(glm::dot(normal / size, s.vertices[v] - corner(s, slice, begin)), slack);
        }
    }
    ASSERT_EQ(sides, 2 * c.edges);
    ASSERT_EQ(passes.size(), c.edges);
    for (const auto& [edge, sum] : passes) ASSERT_EQ(sum, 0) << "edge " << edge;
}

/// Expects that the source numbers of a slice's elements are those of the 4-D elements from which they were cut.
inline void expectCorrectSources(const polytopes::Polytope& p, const slicing::SliceSet& s, int slice) {
    const auto place = [&](std::uint32_t v) { return glm::dvec4(s.vertices[v], s.planes.w(slice)); };
    const auto verticesOfEdgeOrVertex = [&](std::uint32_t source) {
        return source < p.edges.size() ? std::set<std::uint32_t>{p.edges[source][0], p.edges[source][1]}
                                       : std::set<std::uint32_t>{std::uint32_t(source - p.edges.size())};
    };
    const auto verticesOfFace = [&](std::uint32_t f) {
        return std::set<std::uint32_t>(p.faces[f].begin(), p.faces[f].end());
    };
    const auto contains = [](const auto& big, const auto& small) {
        return std::includes(big.begin(), big.end(), small.begin(), small.end());
    };
    for (auto v = s.vertexBegin[slice]; v < s.vertexBegin[slice + 1]; ++v) {
        const auto ends = verticesOfEdgeOrVertex(s.vertexSource[v]);
        const glm::dvec4 a = s.rotatedVertices[*ends.begin()];
        const glm::dvec4 b = s.rotatedVertices[*ends.rbegin()];
        ASSERT_NEAR(glm::distance(a, place(v)) + glm::distance(place(v), b), glm::distance(a, b), 1e-8);
    }
    for (auto e = s.edgeBegin[slice]; e < s.edgeBegin[slice + 1]; ++e) {
        const auto source = s.edgeSource[e];
        const auto whole = source < p.faces.size() ? verticesOfFace(source)
                                                   : verticesOfEdgeOrVertex(std::uint32_t(source - p.faces.size()));
        for (const auto end : s.edges[e]) {
            ASSERT_TRUE(contains(whole, verticesOfEdgeOrVertex(s.vertexSource[s.vertexBegin[slice] + end])));
        }
    }
    for (auto f = s.faceBegin[slice]; f < s.faceBegin[slice + 1]; ++f) {
        const auto source = s.faceSource[f];
        std::set<std::uint32_t> whole;
        if (source < p.cells.size()) {
            for (const auto face : p.cells[source]) whole.merge(verticesOfFace(face));
        } else {
            whole = verticesOfFace(std::uint32_t(source - p.cells.size()));
        }
        for (auto i = s.cornerBegin[f]; i < s.cornerBegin[f + 1]; ++i) {
            ASSERT_TRUE(contains(whole, verticesOfEdgeOrVertex(s.vertexSource[s.vertexBegin[slice] + s.corners[i]])));
        }
    }
}

/// Expects that all slices of the convex polytope `p` in `s` have correct source numbers (from which elements they were
/// cut) and, if they have a volume, are closed convex polyhedra.
inline void expectAllSound(const polytopes::Polytope& p, const slicing::SliceSet& s) {
    for (int i = 0; i < s.planes.count; ++i) {
        expectCorrectSources(p, s, i);
        if (s.faceCount(i) > 1) expectClosedConvexSolid(s, i);
        if (testing::Test::HasFatalFailure()) return;
    }
}

}  // namespace oval4d::support
