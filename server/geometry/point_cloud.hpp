#pragma once

#include <string>
#include <vector>

#include <glm/vec4.hpp>

#include "geometry/object_info.hpp"

namespace oval4d::geometry {

/// A finite set of points in R⁴, each drawn as a ball. Made by makePointCloud; not changed afterward.
struct PointCloud : ObjectInfo {
    std::vector<glm::dvec4> points;
    std::vector<double> radii;  ///< by point: the radius of its ball, in the units of the points; 0: the default
};

/// Makes a cloud from points and the radius of each (see PointCloud::radii). Throws std::invalid_argument with the
/// reason if `radii` and `points` differ in size, a coordinate or a radius is not finite, a radius is negative, or no
/// point lies away from the origin.
PointCloud makePointCloud(std::string name, std::vector<glm::dvec4> points, std::vector<double> radii);

}  // namespace oval4d::geometry
