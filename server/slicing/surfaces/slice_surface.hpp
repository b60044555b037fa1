#pragma once
// The surfaces in one slice of a field, as triangles.

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

namespace oval4d::slicing {

/// The triangles of one slice of a field. For each level, they form a closed surface, oriented outward, around the body
/// of the level: the region where the function is below the level, or above it (see fields::BodySide). The surface
/// consists of the part of the level set in the domain of the field, and of caps. Caps close the surface where the body
/// ends: at the boundary of the domain, or of a hole in which the function has no value. If only the topology was
/// extracted (see SurfaceDetail::topologyOnly), `normals`, `growth` and `values` are empty.
struct SliceSurface {
    /// The bit of SliceSurface::levelAndCap that marks the triangles of caps.
    static constexpr std::uint8_t kCap = 0x80;

    std::vector<glm::vec3> points;  ///< x, y and z of each point, in the units of the object
    /// Per point: the outward unit normal of the level set through the point; without meaning at points of caps alone.
    std::vector<glm::vec3> normals;
    /// Per point: the distance by which the level set moves along its outward normal per unit of w. The number is
    /// positive where the body grows with w, negative where it shrinks, and infinite where the level set is tangent to
    /// the hyperplane.
    std::vector<float> growth;
    std::vector<float> values;  ///< per point: the value of the field's function
    /// Per point: the value of the second function. Empty unless the field has a second function and
    /// SurfaceDetail::secondValues is true.
    std::vector<float> secondValues;
    /// Indices into `points`, counterclockwise as seen from outside the surface.
    std::vector<std::array<std::uint32_t, 3>> triangles;
    /// Per triangle: the index of its level, plus kCap if the triangle belongs to a cap. The triangles are sorted by
    /// level. Within each level, the triangles of caps are last.
    std::vector<std::uint8_t> levelAndCap;

    void clear() {
        points.clear();
        normals.clear();
        growth.clear();
        values.clear();
        secondValues.clear();
        triangles.clear();
        levelAndCap.clear();
    }
    /// Returns, per point, the value that determines its color: `secondValues` unless they are empty, else `values`.
    const std::vector<float>& coloringValues() const { return secondValues.empty() ? values : secondValues; }
    /// Returns the index of the level of triangle t.
    std::size_t levelIndex(std::size_t t) const { return levelAndCap[t] & ~kCap; }
    bool isCap(std::size_t t) const { return (levelAndCap[t] & kCap) != 0; }
};

}  // namespace oval4d::slicing
