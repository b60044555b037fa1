#pragma once
// The choice of the point that becomes the origin of a loaded object.

#include <cstdint>
#include <span>

#include <glm/vec4.hpp>

namespace oval4d::geometry {

/// Which point of the file's coordinates becomes the origin of an object. The object turns about its origin, its size
/// is measured from there, and its slices lie around it.
struct Centering {
    enum class Kind : std::uint8_t {
        automatic,  ///< the center of an object that is far from the origin of the file; else this origin
        object,     ///< the center of the object
        origin,     ///< the origin of the file
        point,      ///< `place`
    };
    Kind kind = Kind::automatic;
    glm::dvec4 place{0};
    bool operator==(const Centering&) const = default;
};

/// Returns the point that becomes the origin of an object with these vertices or points. The center of the object is
/// their mean, rounded to about 11 digits of the object's size. The object is far away if the distance of its center
/// from the origin of the file is more than three times the largest distance of a point from the center, and this is
/// not 0. Returns 0 for the kind `object` if there are no points.
glm::dvec4 centerFor(const Centering& centering, std::span<const glm::dvec4> points);

}  // namespace oval4d::geometry
