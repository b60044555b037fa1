#pragma once
// The lines that show the place of the focus point in the focus slice (the middle one).

#include <array>

#include <glm/vec3.hpp>

#include "scene/scene.hpp"

namespace oval4d::scene {

/// The two ends of a line segment, in view coordinates: the eye is at the origin and looks along −z.
using ViewSegment = std::array<glm::dvec3, 2>;

/// Returns three line segments through the focus point, along x, y and z, in the slice at `placement`. The focus point
/// is the middle of each segment.
std::array<ViewSegment, 3> focusPointSegments(const Scene& scene, const SlicePlacement& placement);

}  // namespace oval4d::scene
