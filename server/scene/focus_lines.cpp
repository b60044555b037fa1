#include "scene/focus_lines.hpp"

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

namespace oval4d::scene {

namespace {

constexpr double kHalfLength = 0.12;  // half the length of each line, in circumradii of the object

}  // namespace

std::array<ViewSegment, 3> focusPointSegments(const Scene& scene, const SlicePlacement& placement) {
    const glm::dmat4 toView = scene.camera.view();
    const auto viewOf = [&](const glm::dvec3& point) {
        return glm::dvec3(toView * glm::dvec4(placement.position + scene.scale * point, 1));
    };
    std::array<ViewSegment, 3> lines;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 step(0);
        step[axis] = kHalfLength * scene.circumradius;
        const glm::dvec3& point = scene.look.focusPoint;
        lines.at(static_cast<std::size_t>(axis)) = {viewOf(point - step), viewOf(point + step)};
    }
    return lines;
}

}  // namespace oval4d::scene
