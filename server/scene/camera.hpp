#pragma once
// The viewport (size in pixels) and the camera of a picture.

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace oval4d::scene {

/// The size of a picture in pixels.
struct Viewport {
    int width = 1280, height = 720;
    bool operator==(const Viewport&) const = default;
};

/// A perspective camera in a right-handed coordinate system. `shiftX` and `shiftY` move the slices in the picture to
/// the right and up, by these fractions of the viewport's width and height. The shift leaves room for other parts of
/// the picture, such as the parallel coordinates.
struct Camera {
    glm::dvec3 eye{0, 0, 1}, target{0}, up{0, 1, 0};  ///< the camera looks from `eye` to `target`
    double fieldOfView = 0.7;                         ///< the vertical angle of view, in radians
    double near = 0.1, far = 100;                     ///< distances of the clipping planes from the eye
    double shiftX = 0, shiftY = 0;

    /// Returns the apparent size, in viewport heights, of a length of 1 at the depth 1 in front of the eye.
    double focalLength() const;
    /// Returns the matrix from world space to view space.
    glm::dmat4 view() const;
    /// Returns the matrix from view space to OpenGL clip space, including the shift. `aspect` is the viewport's width
    /// divided by its height.
    glm::dmat4 projection(double aspect) const;
    bool operator==(const Camera&) const = default;
};

}  // namespace oval4d::scene
