#pragma once

#include <string>
#include <vector>

#include <glm/vec4.hpp>

#include "geometry/object_info.hpp"

namespace oval4d::geometry {

/// A finite set of points in R⁴. Immutable once made.
struct PointCloud : ObjectInfo {
    std::vector<glm::dvec4> points;
    std::vector<double> radii;  ///< of the ball at each point, in the cloud's units; 0: the usual radius
};

/// Makes a cloud; `radii` has as many entries as `points`. Throws std::invalid_argument, saying why, unless there is a
/// point away from the origin, all coordinates are finite, and all radii are finite and not negative.
PointCloud makePointCloud(std::string name, std::vector<glm::dvec4> points, std::vector<double> radii);

}  // namespace oval4d::geometry
