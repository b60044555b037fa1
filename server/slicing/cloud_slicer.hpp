#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "geometry/hyperplanes.hpp"
#include "geometry/point_cloud.hpp"
#include "geometry/rotation.hpp"
#include "slicing/slice_set.hpp"

namespace oval4d::slicing {

/// Returns the default radius of a cloud's balls, as a fraction of the circumradius. The radius decreases as the number
/// of points grows.
double ballRadius(const geometry::PointCloud& cloud);

/// Returns the opacity of a point whose distance from a hyperplane is this multiple of half the spacing, 0 … 1.
inline float opacityAtDistance(double distance) { return static_cast<float>(1 - 0.8 * std::min(distance, 1.0)); }

/// Slices point clouds. A slice shows each point within half a spacing of its hyperplane as a ball, whose opacity falls
/// linearly with the distance, from 1 in the hyperplane to 0.2 at half a spacing. A point halfway between two
/// hyperplanes belongs to the one with the larger w. The source number of a slice vertex (see SliceSet) is the index of
/// its point. A slicer may be used by one thread at a time.
class CloudSlicer {
  public:
    /// Slices `cloud` rotated by `orientation`. Overwrites `out` and reuses its memory.
    void slice(const geometry::PointCloud& cloud, const geometry::Rotation& orientation,
               const geometry::Hyperplanes& planes, SliceSet& out);

  private:
    std::vector<std::int32_t> planeOf_;  // per point: the index of its hyperplane; −1 for none
    std::vector<std::uint32_t> next_;    // per hyperplane: the index of the slice vertex to write next
};

}  // namespace oval4d::slicing
