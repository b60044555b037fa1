#pragma once
// The slices of an object by parallel hyperplanes w = const, as arrays of vertices, edges and faces.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "geometry/hyperplanes.hpp"
#include "slicing/surfaces/slice_fog.hpp"
#include "slicing/surfaces/slice_surface.hpp"

namespace oval4d::slicing {

/// A vertex counts as lying in a hyperplane if its distance from the hyperplane is at most this fraction of the
/// circumradius.
inline constexpr double kOnPlaneTolerance = 1e-9;

/// Numbers of vertices, edges, faces and face corners. They give either the size of one or more slices, or the position
/// of a slice in a SliceSet: the total size of the slices before it.
struct SliceElementCounts {
    std::uint32_t vertices = 0, edges = 0, faces = 0, corners = 0;

    SliceElementCounts operator+(SliceElementCounts more) const {
        return {vertices + more.vertices, edges + more.edges, faces + more.faces, corners + more.corners};
    }
};

/// The slices of an object, stored as a structure of arrays. Slice i has the vertices vertexBegin[i] … vertexBegin[i +
/// 1] − 1; its edges and faces are given likewise by edgeBegin and faceBegin. The vertex indices in `edges` and
/// `corners` are relative to the first vertex of the slice, and the edge indices in `cornerEdges` to the first edge of
/// the slice.
///
/// The source number of an element of a slice says from which element of the object it was cut. For a cell complex,
/// such as a polytope, with E edges, F 2-faces and C cells:
/// - `vertexSource` is the index of the edge that was cut, or E + v if vertex v lies in the hyperplane;
/// - `edgeSource` is the index of the 2-face that was cut, or F + e if edge e lies in the hyperplane;
/// - `faceSource` is the index of the cell that was cut, or C + f if 2-face f lies in the hyperplane.
///
/// For a point cloud, `vertexSource` is the index of the point; slices have no edges or faces. For a field, the
/// vertices, edges and faces are those of the slices of its domain, which is a polytope.
struct SliceSet {
    geometry::Hyperplanes planes;
    std::vector<glm::dvec4> rotatedVertices;  ///< all vertices or points of the object, rotated

    /// Per slice: the index of its first vertex, edge or face; then the total number.
    std::vector<std::uint32_t> vertexBegin, edgeBegin, faceBegin;
    std::vector<glm::dvec3> vertices;  ///< x, y and z of each vertex, in the units of the object
    std::vector<std::uint32_t> vertexSource;
    /// For a point cloud, per vertex: the radius of its ball relative to the default (see relativeBallRadius()), and
    /// the opacity of the ball, from 0 to 1. Empty for other objects, for which all these values are 1. Exception: in a
    /// projection, some vertices may have no balls, which is stored as the opacity 0 (see Projector::project()).
    std::vector<float> ballScale, ballOpacity;
    std::vector<std::array<std::uint32_t, 2>> edges;
    std::vector<std::uint32_t> edgeSource;
    std::vector<std::uint32_t> cornerBegin;  ///< per face: the index of its first corner; then the number of corners
    std::vector<std::uint32_t> corners;  ///< the loop of each face: its vertices, counterclockwise seen from outside
    std::vector<std::uint32_t> cornerEdges;  ///< entry i is the slice edge from corner i to the next corner of the face
    std::vector<std::uint32_t> faceSource;
    std::vector<SliceSurface> surfaces;  ///< for a field: one entry per slice; otherwise empty
    std::vector<SliceFog> fogs;          ///< for a field with fog: one entry per slice; otherwise empty

    /// Returns whether a vertex has a ball.
    bool hasBall(std::size_t vertex) const { return ballOpacity.empty() || ballOpacity[vertex] > 0; }
    std::size_t vertexCount(int slice) const { return vertexBegin[slice + 1] - vertexBegin[slice]; }
    std::size_t edgeCount(int slice) const { return edgeBegin[slice + 1] - edgeBegin[slice]; }
    std::size_t faceCount(int slice) const { return faceBegin[slice + 1] - faceBegin[slice]; }

    /// Returns the total size of all slices. The set must not be default-constructed, because its lists are then empty.
    SliceElementCounts totalCounts() const {
        return {vertexBegin.back(), edgeBegin.back(), faceBegin.back(), cornerBegin.back()};
    }
    /// Resizes the arrays for planes.count slices that together have the size `size`.
    void resize(SliceElementCounts size);
    /// Records that slice number `slice` begins at the position `at` in the arrays.
    void setSliceBegin(int slice, SliceElementCounts at) {
        vertexBegin[slice] = at.vertices;
        edgeBegin[slice] = at.edges;
        faceBegin[slice] = at.faces;
    }
    /// Records that the last slice ends at the position `at` in the arrays, and truncates the arrays there.
    void finishSlices(SliceElementCounts at);
    /// Removes all slices with their vertices, edges and faces, so that appendSlices() can add others. Keeps the
    /// planes, surfaces and fogs.
    void clearSlices();
    /// Adds the vertices, edges and faces of all slices of `more` after the last slice of this set. Does not add
    /// surfaces and fogs.
    void appendSlices(const SliceSet& more);
};

/// A set without slices.
inline const SliceSet kNoSlices;

}  // namespace oval4d::slicing
