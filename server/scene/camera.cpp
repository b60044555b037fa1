#include "scene/camera.hpp"

#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

namespace oval4d::scene {

double Camera::focalLength() const { return 0.5 / std::tan(fieldOfView / 2); }

glm::dmat4 Camera::view() const { return glm::lookAt(eye, target, up); }

glm::dmat4 Camera::projection(double aspect) const {
    glm::dmat4 matrix = glm::perspective(fieldOfView, aspect, near, far);
    // Shifts the clip coordinates x and y by 2 · shift · w. The clip coordinate w equals −z in view space.
    matrix[2][0] = -2 * shiftX;
    matrix[2][1] = -2 * shiftY;
    return matrix;
}

}  // namespace oval4d::scene
