#pragma once
// The closed surface of a body in a slice of a field.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

namespace oval4d::slicing {

/// The boundary of the body of one level (see fields::Inside) in one slice of a field: a closed surface, oriented
/// outward.
struct ClosedSurface {
    std::vector<glm::dvec3> points;                       ///< in the units of the object
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counterclockwise, seen from outside the body
    /// The index of the first triangle of the caps; the triangles before it form the level set. Caps close the surface
    /// where the body ends at the boundary of the domain, or of a hole in which the function has no value.
    std::size_t firstCap = 0;

    void clear() {
        points.clear();
        triangles.clear();
        firstCap = 0;
    }
};

}  // namespace oval4d::slicing
