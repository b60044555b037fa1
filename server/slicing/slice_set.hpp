#pragma once
// The slices of a polytope by parallel hyperplanes w = const.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "geometry/hyperplanes.hpp"

namespace oval4d::slicing {

/// A vertex lies in a hyperplane if their distance is at most this fraction of the circumradius.
inline constexpr double kOnPlane = 1e-9;

/// Numbers of slice elements: the size of one slice, or of all slices before it, which is where its elements begin.
struct ElementCounts {
    std::uint32_t vertices = 0, edges = 0, faces = 0, corners = 0;

    ElementCounts operator+(ElementCounts more) const {
        return {vertices + more.vertices, edges + more.edges, faces + more.faces, corners + more.corners};
    }
};

/// Many slices in one set of arrays (structure of arrays). Slice i has the half-open ranges [xBegin[i], xBegin[i+1]) of
/// vertices, edges and faces; vertex indices in `edges` and `corners` count from the slice's own first vertex, edge
/// indices in `cornerEdges` from its first edge.
///
/// Source numbers: `vertexSource` is the index of the 4-D edge that was cut, or edges + v if polytope vertex v lies in
/// the hyperplane; `edgeSource` is the index of the 2-face that was cut, or faces + e if edge e lies in the hyperplane;
/// `faceSource` is the index of the cell that was cut, or cells + f if 2-face f lies in the hyperplane. Here edges,
/// faces and cells are the polytope's numbers of them.
struct SliceSet {
    geometry::Hyperplanes planes;
    std::vector<glm::dvec4> rotatedVertices;  ///< the rotated vertices of the polytope

    std::vector<std::uint32_t> vertexBegin, edgeBegin, faceBegin;  ///< planes.count + 1 each
    std::vector<glm::dvec3> vertices;
    std::vector<std::uint32_t> vertexSource;
    /// For objects whose balls differ, the relative radius and the opacity of the ball at each vertex. Empty if all
    /// are 1.
    std::vector<float> ballScale, ballOpacity;
    std::vector<std::array<std::uint32_t, 2>> edges;
    std::vector<std::uint32_t> edgeSource;
    std::vector<std::uint32_t> cornerBegin;  ///< faces + 1 entries; face f is the loop corners[cornerBegin[f]] …
    std::vector<std::uint32_t> corners;      ///< vertex indices, counterclockwise seen from outside
    std::vector<std::uint32_t> cornerEdges;  ///< the slice edge from corner i to the next corner of the loop
    std::vector<std::uint32_t> faceSource;

    std::size_t vertexCount(int slice) const { return vertexBegin[slice + 1] - vertexBegin[slice]; }
    std::size_t edgeCount(int slice) const { return edgeBegin[slice + 1] - edgeBegin[slice]; }
    std::size_t faceCount(int slice) const { return faceBegin[slice + 1] - faceBegin[slice]; }

    /// The total size of all slices.
    ElementCounts size() const { return {vertexBegin.back(), edgeBegin.back(), faceBegin.back(), cornerBegin.back()}; }
    /// Resizes the arrays for planes.count slices with this total size.
    void resize(ElementCounts size);
    /// Records that slice number `slice` begins at `at`.
    void begin(int slice, ElementCounts at) {
        vertexBegin[slice] = at.vertices;
        edgeBegin[slice] = at.edges;
        faceBegin[slice] = at.faces;
    }
    /// Records that the last slice ends at `at`, and truncates the arrays there.
    void end(ElementCounts at);
};

/// An empty set of slices.
inline const SliceSet kNoSlices;

}  // namespace oval4d::slicing
