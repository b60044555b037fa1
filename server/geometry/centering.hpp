#pragma once
// The choice of the point that becomes the origin of a loaded object.

#include <cstdint>
#include <span>

#include <glm/vec4.hpp>

namespace oval4d::geometry {

/// Says which point of a file becomes the origin of the object that is loaded from the file. The object turns about its
/// origin, its size is measured from there, and its slices lie around it.
struct Centering {
    enum class OriginChoice : std::uint8_t {
        automatic,  ///< like the choice `object` if the object is far from the origin of the file (see
                    ///< newOriginFor()), else like the choice `origin`
        object,     ///< the center of the object
        origin,     ///< the origin of the file
        point,      ///< the point `place`
    };
    OriginChoice choice = OriginChoice::automatic;
    glm::dvec4 place{0};  ///< used only by the choice `point`, in the coordinates of the file
    bool operator==(const Centering&) const = default;
};

/// Returns the point that becomes the origin of an object with these vertices or points, in the coordinates of the
/// file. The center of the object is the mean of the points, rounded to a multiple of about 10⁻¹¹ of the object's
/// extent. The extent is the largest distance of a point from the center. The object is far from the origin of the file
/// if its extent is not 0 and its center is more than three extents from this origin. If there are no points, returns
/// the zero vector for every choice.
glm::dvec4 newOriginFor(const Centering& centering, std::span<const glm::dvec4> points);

}  // namespace oval4d::geometry
