#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <glm/vec4.hpp>

#include "geometry/object_info.hpp"
#include "geometry/range.hpp"
#include "geometry/reference_frame.hpp"
#include "serialization/stored_members.hpp"

namespace oval4d::geometry {

/// A finite set of points in R⁴, each drawn as a ball. makePointCloud() and transformedTo() make point clouds, which do
/// not change afterward.
struct PointCloud : ObjectInfo {
    std::vector<glm::dvec4> points;
    /// The radius of each point's ball, in the units of the points. If it is 0, the ball gets the default radius of
    /// slicing::relativeBallRadius().
    std::vector<double> radii;
};
static_assert(serialization::HasOwnMembers<PointCloud, ObjectInfo, 2>, "visitStoredMembers() considers each member");
void visitStoredMembers(serialization::ReadOrWritten<PointCloud> auto& cloud, auto& visit) {
    visit.member(0, serialization::asBase<ObjectInfo>(cloud));
    visit.member(1, cloud.points, ObjectInfo::kStoredCoordinates);
    visit.member(2, cloud.radii, NumberRange{0, ObjectInfo::kStoredCoordinates.most});
}

/// Makes a cloud from points and the radius of each point's ball (see PointCloud::radii). Throws std::invalid_argument
/// with the reason if `radii` and `points` differ in size, if a point's distance from the origin or a radius is not
/// finite, if a radius is negative, or if there are no points. If all points are at the origin, the circumradius is the
/// largest radius or, if all radii are 0, it is 1.
PointCloud makePointCloud(std::string name, std::vector<glm::dvec4> points, std::vector<double> radii);

/// Returns the memory that the cloud occupies, in bytes. The text of its name does not count.
std::size_t memoryOf(const PointCloud& cloud);

/// Returns the cloud in the coordinates of the frame of reference `frame`, with the serial number `serial`. The radii
/// of the balls do not change.
PointCloud transformedTo(const PointCloud& cloud, const ReferenceFrame& frame, std::uint64_t serial);

}  // namespace oval4d::geometry
