#pragma once
// The slices of a polytope by parallel hyperplanes w = const.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace oval4d::geometry {

/// So many elements of slices: of one, or of all before one, where its own then begin.
struct SliceSize {
    std::uint32_t vertices = 0, edges = 0, faces = 0, corners = 0;

    SliceSize operator+(SliceSize more) const {
        return {vertices + more.vertices, edges + more.edges, faces + more.faces, corners + more.corners};
    }
};

/// The hyperplanes w = n · spacing for n = first … first + count − 1.
struct Hyperplanes {
    int first = -10;
    int count = 21;
    double spacing = 0.1;

    double w(int i) const { return (first + i) * spacing; }
    bool operator==(const Hyperplanes&) const = default;
};

/// Many slices in one set of arrays. Slice i owns the half-open ranges [xBegin[i], xBegin[i+1]) of vertices, edges
/// and faces; vertex indices in `edges` and `corners` count from the slice's own first vertex, edge indices in
/// `cornerEdges` from its first edge.
///
/// "Of" numbers: vertexOf is the 4-D edge that was cut, or edges + v where polytope vertex v lies in the hyperplane;
/// edgeOf is the 2-face that was cut, or faces + e where edge e lies in it; faceOf is the cell that was cut, or
/// cells + f where 2-face f lies in it.
struct SliceSet {
    Hyperplanes planes;
    std::vector<glm::dvec4> turned;  ///< the polytope's vertices as turned

    std::vector<std::uint32_t> vertexBegin, edgeBegin, faceBegin;  ///< planes.count + 1 each
    std::vector<glm::dvec3> vertices;
    std::vector<std::uint32_t> vertexOf;
    std::vector<std::array<std::uint32_t, 2>> edges;
    std::vector<std::uint32_t> edgeOf;
    std::vector<std::uint32_t> cornerBegin;  ///< faces + 1; face f is the loop corners[cornerBegin[f]] …
    std::vector<std::uint32_t> corners;      ///< counter-clockwise seen from outside
    std::vector<std::uint32_t> cornerEdges;  ///< the slice edge from corner i to the next corner of the loop
    std::vector<std::uint32_t> faceOf;

    std::size_t vertexCount(int slice) const { return vertexBegin[slice + 1] - vertexBegin[slice]; }
    std::size_t edgeCount(int slice) const { return edgeBegin[slice + 1] - edgeBegin[slice]; }
    std::size_t faceCount(int slice) const { return faceBegin[slice + 1] - faceBegin[slice]; }

    /// Of all slices.
    SliceSize size() const { return {vertexBegin.back(), edgeBegin.back(), faceBegin.back(), cornerBegin.back()}; }
    /// Makes room for slices of so many elements together, and planes.count of them.
    void resize(SliceSize size);
    /// Slice number `slice` begins at `at`.
    void begin(int slice, SliceSize at) {
        vertexBegin[slice] = at.vertices;
        edgeBegin[slice] = at.edges;
        faceBegin[slice] = at.faces;
    }
    /// The last slice ends at `at`, and what is behind is let go.
    void end(SliceSize at);
};

}  // namespace oval4d::geometry
