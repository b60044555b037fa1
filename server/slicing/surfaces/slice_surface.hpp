#pragma once
// The surfaces in one slice of a field.

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

namespace oval4d::slicing {

/// The triangles of one slice of a field. For each level, they form a closed surface, oriented outward, around the body
/// of the level (see fields::Inside): the part of the level set that lies in the domain of the field, and caps where
/// the body ends at the boundary of the domain, or of a hole in which the function has no value. If only the topology
/// was extracted (see SurfaceDetail::topologyOnly), `normals`, `growth` and `values` are empty.
struct SliceSurface {
    /// The bit of SliceSurface::levelAndCap that marks the triangles of caps.
    static constexpr std::uint8_t kCap = 0x80;

    std::vector<glm::vec3> points;   ///< their x, y and z, in the units of the object
    std::vector<glm::vec3> normals;  ///< per point: the outward unit normal of its level set; meaningless on caps
    /// Per point: the distance by which the level set moves along its outward normal per unit of w. Positive where the
    /// body grows with w, negative where it shrinks, and infinite where the level set is tangent to the hyperplane.
    std::vector<float> growth;
    std::vector<float> values;  ///< per point: the value of the function
    /// Per point: the value of the second function. Empty unless the field has one and SurfaceDetail::secondValues is
    /// true.
    std::vector<float> secondValues;
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counterclockwise, seen from outside the body
    /// Per triangle: the index of its level, plus kCap if it belongs to a cap. The triangles are sorted by level;
    /// within each level, those of the caps are last.
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
    /// Returns the values that determine the colors of the points: those of the second function, if there are any, else
    /// those of the first.
    const std::vector<float>& coloringValues() const { return secondValues.empty() ? values : secondValues; }
    /// Returns the index of the level of triangle t.
    std::size_t levelIndex(std::size_t t) const { return levelAndCap[t] & ~kCap; }
    bool isCap(std::size_t t) const { return (levelAndCap[t] & kCap) != 0; }
};

}  // namespace oval4d::slicing
