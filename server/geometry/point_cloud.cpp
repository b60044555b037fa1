#include "geometry/point_cloud.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

namespace oval4d::geometry {

PointCloud makePointCloud(std::string name, std::vector<glm::dvec4> points, std::vector<double> radii) {
    if (points.size() != radii.size()) throw std::invalid_argument("the numbers of points and of radii differ");
    PointCloud cloud;
    for (const glm::dvec4& point : points) {
        const double r = glm::length(point);
        if (!std::isfinite(r)) throw std::invalid_argument("a point is not finite");
        cloud.circumradius = std::max(cloud.circumradius, r);
    }
    if (!(cloud.circumradius > 0)) throw std::invalid_argument("there is no point away from the origin");
    for (const double radius : radii) {
        if (!(radius >= 0 && std::isfinite(radius))) throw std::invalid_argument("a radius is negative or not finite");
    }
    cloud.serial = nextSerial();
    cloud.name = std::move(name);
    cloud.points = std::move(points);
    cloud.radii = std::move(radii);
    return cloud;
}

PointCloud imageOf(const PointCloud& cloud, const ReferenceFrame& frame, std::uint64_t serial) {
    PointCloud image = cloud;
    image.serial = serial;
    image.rebuildableFromName = false;
    image.circumradius = mapPoints(frame.matrix(), image.points);
    return image;
}

}  // namespace oval4d::geometry
