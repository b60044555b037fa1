#pragma once
// The projection of the scene's camera in single precision.

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "scene/scene.hpp"

namespace oval4d::render {

/// Projects view coordinates (the eye at the origin, x to the right, y up, z toward the viewer) to the picture.
struct Projection {
    float width = 1, height = 1;   ///< size of the picture in pixels
    float scaleX = 1, scaleY = 1;  ///< cotangents of half the horizontal and half the vertical field of view
    float shiftX = 0, shiftY = 0;  ///< the point where the view axis meets the picture: −1 … 1, 0 is the center

    static Projection of(const scene::Camera& camera, scene::Viewport viewport) {
        const auto projection = glm::mat4(camera.projection(static_cast<double>(viewport.width) / viewport.height));
        return {static_cast<float>(viewport.width),
                static_cast<float>(viewport.height),
                projection[0][0],
                projection[1][1],
                -projection[2][0],
                -projection[2][1]};
    }

    /// Returns the clip coordinates (x, y, w) of a point, without z.
    glm::vec3 clip(const glm::vec3& v) const {
        return {scaleX * v.x - shiftX * v.z, scaleY * v.y - shiftY * v.z, -v.z};
    }

    /// Returns the pixel coordinates of a point, from the lower left corner.
    glm::vec2 pixel(const glm::vec3& v) const {
        const glm::vec3 c = clip(v);
        return {(c.x / c.z * 0.5f + 0.5f) * width, (c.y / c.z * 0.5f + 0.5f) * height};
    }

    /// Returns the focal length in pixels: a length perpendicular to the view axis, at distance d, is drawn with
    /// focalLength() / d pixels per unit.
    float focalLength() const { return 0.5f * scaleY * height; }
};

}  // namespace oval4d::render
