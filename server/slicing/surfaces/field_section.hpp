#pragma once
// Where one slice of a field lies: its hyperplane, and the part of the field's domain in it.

#include <array>
#include <cstddef>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace oval4d::slicing {

/// The hyperplane of one slice of a field, and the slice of the field's domain, which is a convex polyhedron in the
/// hyperplane. A point of the hyperplane has the coordinates x, y and z of the slice, in the units of the object, and
/// the function's coordinates origin + x · axes[0] + y · axes[1] + z · axes[2].
struct FieldSection {
    /// A half-space of the hyperplane: the points p = (x, y, z) with dot(normal, p) ≤ offset. `normal` is a unit
    /// vector.
    struct HalfSpace {
        glm::dvec3 normal;
        double offset;
    };
    static constexpr std::size_t kMaxWalls = 8;

    glm::dvec4 origin{0};  ///< the point x = y = z = 0, in the function's coordinates
    /// The vectors of length 1 along x, y and z of the slice, in the function's coordinates.
    std::array<glm::dvec4, 3> axes{};
    glm::dvec4 normal{0};          ///< the vector of length 1 along w, in the function's coordinates
    std::vector<HalfSpace> walls;  ///< at most kMaxWalls half-spaces, whose intersection is the slice of the domain
    glm::dvec3 min{0}, max{0};     ///< opposite corners of a box that contains the slice of the domain
};

}  // namespace oval4d::slicing
