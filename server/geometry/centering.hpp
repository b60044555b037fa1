#pragma once
// The choice of the point that becomes the origin of a loaded object.

#include <cstdint>
#include <span>

#include <glm/vec4.hpp>

namespace oval4d::geometry {

/// The choice of the point that becomes the origin of an object loaded from a file. The object turns about its origin.
/// Its size is measured from its origin, and its slices lie around its origin.
struct Centering {
    enum class OriginChoice : std::uint8_t {
        automatic,  ///< the choice `object` if the object is far from the origin of the file (see newOriginFor()), else
                    ///< the choice `origin`
        object,     ///< the center of the object
        origin,     ///< the origin of the file
        point,      ///< the point `place`
    };
    OriginChoice choice = OriginChoice::automatic;
    glm::dvec4 place{0};  ///< the new origin, in the coordinates of the file; used only for the choice `point`
    bool operator==(const Centering&) const = default;
};

/// Returns the point that becomes the origin of an object, in the coordinates of the file. `points` are the vertices or
/// points of the object. If there are none, returns the zero vector for every choice.
///
/// The center of the object is the mean of `points`. The extent is the largest distance of a point from the center. The
/// object is far from the origin of the file if its extent is not 0 and its center is more than three extents from this
/// origin. The coordinates of a returned center are rounded to multiples of about 10⁻¹¹ of the extent.
glm::dvec4 newOriginFor(const Centering& centering, std::span<const glm::dvec4> points);

}  // namespace oval4d::geometry
