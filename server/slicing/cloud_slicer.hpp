#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "geometry/hyperplanes.hpp"
#include "geometry/point_cloud.hpp"
#include "geometry/rotation.hpp"
#include "slicing/slice_set.hpp"

namespace oval4d::slicing {

/// Returns the default radius of the balls that show the points of a cloud, as a fraction of the cloud's circumradius:
/// from 0.06 for few points to 0.015 for many.
double relativeBallRadius(const geometry::PointCloud& cloud);

/// Returns the opacity of the ball that shows a point of a cloud. `distance` is the distance of the point from the
/// hyperplane, in units of half the spacing. The opacity decreases linearly from 1 at the distance 0 to 0.2 at the
/// distance 1, and is 0.2 beyond.
inline float opacityAtDistance(double distance) { return static_cast<float>(1 - 0.8 * std::min(distance, 1.0)); }

/// Slices point clouds. A slice contains the points from half a spacing below its hyperplane, included, to half a
/// spacing above it, not included. If the hyperplanes are evenly spaced, a point is in at most one slice. If the
/// hyperplanes are listed (see Hyperplanes::listed), a point may be in several slices. A slice shows each point as a
/// ball. The opacity of the ball decreases linearly with the distance of the point from the hyperplane, from 1 to 0.2
/// at half a spacing. Only one thread at a time may use a slicer.
class CloudSlicer {
  public:
    /// Slices `cloud`, rotated by `orientation`, and writes the slices to `out`. Overwrites `out`, except its surfaces
    /// and fogs, and reuses its memory.
    void slice(const geometry::PointCloud& cloud, const geometry::Rotation& orientation,
               const geometry::Hyperplanes& planes, SliceSet& out);

  private:
    std::vector<std::int32_t> planeOf_;  // per point: the index of the hyperplane whose slice contains it; −1 for none
    std::vector<std::uint32_t> next_;    // per hyperplane: the index at which its next slice vertex is written
};

}  // namespace oval4d::slicing
