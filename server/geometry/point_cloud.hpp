#pragma once

#include <string>
#include <vector>

#include <glm/vec4.hpp>

#include "geometry/object_info.hpp"

namespace oval4d::geometry {

/// A finite set of points in R⁴, each drawn as a ball. Made by makePointCloud; not changed afterward.
struct PointCloud : ObjectInfo {
    std::vector<glm::dvec4> points;
    std::vector<double> radii;  ///< the radius of each point's ball, in the units of the points; 0 means the default
};

/// Makes a cloud from points and the radius of each point's ball (see PointCloud::radii). Throws std::invalid_argument
/// with the reason if `radii` and `points` differ in size, if a coordinate or a radius is not finite, if a radius is
/// negative, or if no point differs from the origin.
PointCloud makePointCloud(std::string name, std::vector<glm::dvec4> points, std::vector<double> radii);

}  // namespace oval4d::geometry
