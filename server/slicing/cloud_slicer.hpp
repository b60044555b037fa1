#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "geometry/hyperplanes.hpp"
#include "geometry/point_cloud.hpp"
#include "geometry/rotation.hpp"
#include "slicing/slice_set.hpp"

namespace oval4d::slicing {

/// Returns the default radius of a cloud's balls, as a fraction of the circumradius: from 0.06 for few points to 0.015
/// for many.
double relativeBallRadius(const geometry::PointCloud& cloud);

/// Returns the opacity, 1 … 0.2, of a ball whose center has this distance from the hyperplane. The unit of `distance`
/// is half the spacing of the hyperplanes; a distance greater than 1 counts as 1.
inline float opacityAtDistance(double distance) { return static_cast<float>(1 - 0.8 * std::min(distance, 1.0)); }

/// Slices point clouds. A slice contains the points from half a spacing below its hyperplane, included, to half a
/// spacing above it, not included. Therefore a point is in at most one slice if the hyperplanes are evenly spaced, but
/// may be in several slices if the hyperplanes are listed (see Hyperplanes::listed). A slice shows a point as a ball,
/// whose opacity decreases linearly with the distance of the point from the hyperplane, from 1 to 0.2 at half a
/// spacing. Only one thread at a time may use a slicer.
class CloudSlicer {
  public:
    /// Slices `cloud` rotated by `orientation`. Overwrites `out`, except its surfaces and fogs, and reuses its memory.
    void slice(const geometry::PointCloud& cloud, const geometry::Rotation& orientation,
               const geometry::Hyperplanes& planes, SliceSet& out);

  private:
    std::vector<std::int32_t> planeOf_;  // per point: the index of its hyperplane; −1 for none
    std::vector<std::uint32_t> next_;    // per hyperplane: the index of the slice vertex to write next
};

}  // namespace oval4d::slicing
