#pragma once
// The closed surface that bounds one region of a field in a slice.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace oval4d::slicing {

/// The boundary of a body in one slice of a field: a closed surface of triangles, oriented outward. The body is the
/// region where the function is below a level, or above it (see fields::BodySide).
struct ClosedSurface {
    std::vector<glm::dvec3> points;  ///< the corners of the triangles: x, y and z in the rotated object
    /// Indices into `points`, counterclockwise as seen from outside the surface.
    std::vector<std::array<std::uint32_t, 3>> triangles;
    /// The index in `triangles` of the first triangle of the caps. The triangles before it form the level set: the
    /// points where the function equals the level. Caps close the surface where the body ends: at the boundary of the
    /// domain, or of a hole in which the function has no value.
    std::size_t firstCap = 0;
    /// Per point: the value of the interpolated function. Empty unless
    /// ClosedSurfaceSlicer::IsosurfaceOptions::pointData is true.
    std::vector<float> values;
    /// Per point: a vector in the direction of the gradient of the interpolated function, with components along x, y, z
    /// and w of the rotated object. The gradient at a point is the mean of the gradients in the simplices around the
    /// point, weighted by the areas of the level set's triangles in these simplices. The length of the vector has no
    /// meaning. The vector is 0 at points that are only on caps. Empty unless
    /// ClosedSurfaceSlicer::IsosurfaceOptions::pointData is true.
    std::vector<glm::dvec4> gradients;

    void clear() {
        values.clear();
        gradients.clear();
        points.clear();
        triangles.clear();
        firstCap = 0;
    }
};

}  // namespace oval4d::slicing
