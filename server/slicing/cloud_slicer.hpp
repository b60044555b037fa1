#pragma once

#include <cstdint>
#include <vector>

#include "geometry/hyperplanes.hpp"
#include "geometry/point_cloud.hpp"
#include "geometry/rotation.hpp"
#include "slicing/slice_set.hpp"

namespace oval4d::slicing {

/// The radius of the usual ball of a cloud, relative to the circumradius: smaller the more points there are.
double ballRadius(const geometry::PointCloud& cloud);

/// Assigns points to hyperplanes: a slice shows the points within half a spacing of its hyperplane as balls, fainter
/// the farther away they are, down to a fifth at half a spacing. A point exactly between two hyperplanes belongs to the
/// one with the larger w. The source number of a vertex is the number of its point. One slicer serves one thread at a
/// time.
class CloudSlicer {
  public:
    /// Turns `cloud` and slices it. Overwrites `out` and reuses its memory.
    void slice(const geometry::PointCloud& cloud, const geometry::Rotation& orientation,
               const geometry::Hyperplanes& planes, SliceSet& out);

  private:
    std::vector<std::int32_t> planeOf_;  // of each point; −1: none
    std::vector<std::uint32_t> next_;    // by hyperplane: the place of its next vertex
};

}  // namespace oval4d::slicing
