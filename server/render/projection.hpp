#pragma once
// The projection of a scene's camera from view coordinates to pixels, in single precision.

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "scene/scene.hpp"

namespace oval4d::render {

/// Projects points from view coordinates to the picture. In view coordinates, the eye is at the origin, x points to the
/// right, y up, and z toward the viewer.
struct ViewProjection {
    float width = 1, height = 1;   ///< the size of the picture in pixels
    float scaleX = 1, scaleY = 1;  ///< the cotangents of half the horizontal and half the vertical field of view
    /// The place where the view axis meets the picture: 0 is the center of the picture, −1 its left or lower edge, and
    /// 1 its right or upper edge.
    float shiftX = 0, shiftY = 0;

    /// Makes the projection of `camera` for pictures with the size of `viewport`.
    static ViewProjection fromCamera(const scene::Camera& camera, scene::Viewport viewport) {
        const auto projection = glm::mat4(camera.projection(static_cast<double>(viewport.width) / viewport.height));
        return {static_cast<float>(viewport.width),
                static_cast<float>(viewport.height),
                projection[0][0],
                projection[1][1],
                -projection[2][0],
                -projection[2][1]};
    }

    /// Returns the clip coordinates x, y and w of the point v in view coordinates.
    glm::vec3 clipXyw(const glm::vec3& v) const {
        return {scaleX * v.x - shiftX * v.z, scaleY * v.y - shiftY * v.z, -v.z};
    }

    /// Returns the position in the picture of the point v in view coordinates, in pixels from the lower left corner.
    /// The point must be in front of the eye.
    glm::vec2 pixel(const glm::vec3& v) const {
        const glm::vec3 c = clipXyw(v);
        return {(c.x / c.z * 0.5f + 0.5f) * width, (c.y / c.z * 0.5f + 0.5f) * height};
    }

    /// Returns the focal length in pixels. A length L perpendicular to the view axis, at the distance d from the eye,
    /// takes L · focalLengthInPixels() / d pixels in the picture.
    float focalLengthInPixels() const { return 0.5f * scaleY * height; }
};

}  // namespace oval4d::render
