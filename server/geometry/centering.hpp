#pragma once
// The choice of the point that becomes the origin of a loaded object.

#include <cstdint>
#include <span>

#include <glm/vec4.hpp>

namespace oval4d::geometry {

/// The choice of the point of a file that becomes the origin of the object in the file. The object turns about its
/// origin. Its size is measured from its origin, and its slices lie around its origin.
struct Centering {
    enum class OriginChoice : std::uint8_t {
        automatic,  ///< the choice `object` if the object is far from the origin of the file (see newOriginFor()), else
                    ///< the choice `origin`
        object,     ///< the center of the object
        origin,     ///< the origin of the file
        point,      ///< the point `place`
    };
    OriginChoice choice = OriginChoice::automatic;
    glm::dvec4 place{0};  ///< the new origin for the choice `point`, in the coordinates of the file; else not used
    bool operator==(const Centering&) const = default;
};

/// Returns the point that becomes the origin of an object with these vertices or points, in the coordinates of the
/// file. The center of the object is the mean of the points, rounded to a multiple of about 10⁻¹¹ of the object's
/// extent. The extent is the largest distance of a point from the center. The object is far from the origin of the file
/// if its extent is not 0 and its center is more than three extents from this origin. If there are no points, returns
/// the zero vector for every choice.
glm::dvec4 newOriginFor(const Centering& centering, std::span<const glm::dvec4> points);

}  // namespace oval4d::geometry
