#include "geometry/point_cloud.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

namespace oval4d::geometry {

namespace {

// Returns ObjectInfo::circumradius of a point cloud: `distance`, the largest distance of a point from the origin. If
// `distance` is 0, returns the largest of `radii`, or 1 if no radius is greater than 0.
double circumradiusOf(double distance, const std::vector<double>& radii) {
    if (distance > 0) return distance;
    const double largest = radii.empty() ? 0 : std::ranges::max(radii);
    return largest > 0 ? largest : 1;
}

}  // namespace

PointCloud makePointCloud(std::string name, std::vector<glm::dvec4> points, std::vector<double> radii) {
    if (points.size() != radii.size()) throw std::invalid_argument("the numbers of points and of radii differ");
    PointCloud cloud;
    for (const glm::dvec4& point : points) {
        const double r = glm::length(point);
        if (!std::isfinite(r)) throw std::invalid_argument("a point is not finite");
        cloud.circumradius = std::max(cloud.circumradius, r);
    }
    if (points.empty()) throw std::invalid_argument("there are no points");
    for (const double radius : radii) {
        if (!(radius >= 0 && std::isfinite(radius))) throw std::invalid_argument("a radius is negative or not finite");
    }
    cloud.circumradius = circumradiusOf(cloud.circumradius, radii);
    cloud.serial = nextSerial();
    cloud.name = std::move(name);
    cloud.points = std::move(points);
    cloud.radii = std::move(radii);
    return cloud;
}

std::size_t memoryOf(const PointCloud& cloud) {
    return sizeof cloud + cloud.points.size() * (sizeof(glm::dvec4) + sizeof(double));
}

PointCloud transformedTo(const PointCloud& cloud, const ReferenceFrame& frame, std::uint64_t serial) {
    PointCloud image = cloud;
    image.serial = serial;
    image.rebuildableFromName = false;
    image.circumradius = circumradiusOf(mapPoints(frame.matrix(), image.points), image.radii);
    image.originInFile = frame.matrix() * cloud.originInFile;
    return image;
}

}  // namespace oval4d::geometry
