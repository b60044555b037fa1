#include "slicing/cloud_slicer.hpp"

#include <algorithm>
#include <cmath>

#include <glm/mat4x4.hpp>

#include "slicing/listed_hyperplanes.hpp"

namespace oval4d::slicing {

double relativeBallRadius(const geometry::PointCloud& cloud) {
    // In four dimensions, the distance between neighboring points is proportional to (the number of points)^(−1/4).
    constexpr double kLargest = 0.06, kSmallest = 0.015;
    return std::clamp(0.14 * std::pow(static_cast<double>(cloud.points.size()), -0.25), kSmallest, kLargest);
}

void CloudSlicer::slice(const geometry::PointCloud& cloud, const geometry::Rotation& orientation,
                        const geometry::Hyperplanes& planes, SliceSet& out) {
    if (!planes.listed.empty()) {
        cutEachHyperplane(planes, out, [&](const geometry::Hyperplanes& plane, SliceSet& one) {
            slice(cloud, orientation, plane, one);
        });
        return;
    }
    out.planes = planes;
    const std::size_t count = cloud.points.size();
    const glm::dmat4 matrix = orientation.matrix();
    out.rotatedVertices.resize(count);
    planeOf_.resize(count);
    next_.assign(static_cast<std::size_t>(planes.count) + 1, 0);
    for (std::size_t p = 0; p < count; ++p) {
        out.rotatedVertices[p] = matrix * cloud.points[p];
        const double plane =
            std::floor((out.rotatedVertices[p].w - planes.offset) / planes.spacing + 0.5) - planes.first;
        planeOf_[p] = plane >= 0 && plane < planes.count ? static_cast<std::int32_t>(plane) : -1;
        if (planeOf_[p] >= 0) ++next_[static_cast<std::size_t>(planeOf_[p]) + 1];
    }
    for (std::size_t i = 1; i < next_.size(); ++i) next_[i] += next_[i - 1];

    SliceElementCounts size;
    size.vertices = next_.back();
    out.resize(size);
    for (int i = 0; i <= planes.count; ++i) out.setSliceBegin(i, {next_[static_cast<std::size_t>(i)], 0, 0, 0});
    out.cornerBegin.assign(1, 0);
    out.ballScale.resize(size.vertices);
    out.ballOpacity.resize(size.vertices);
    const double usual = relativeBallRadius(cloud) * cloud.circumradius;
    for (std::size_t p = 0; p < count; ++p) {
        if (planeOf_[p] < 0) continue;
        const std::uint32_t at = next_[static_cast<std::size_t>(planeOf_[p])]++;
        out.vertices[at] = out.rotatedVertices[p];
        out.vertexSource[at] = static_cast<std::uint32_t>(p);
        const double distance = std::abs(out.rotatedVertices[p].w - planes.w(planeOf_[p])) / (planes.spacing / 2);
        out.ballOpacity[at] = opacityAtDistance(distance);
        out.ballScale[at] = static_cast<float>(cloud.radii[p] > 0 ? cloud.radii[p] / usual : 1);
    }
}

}  // namespace oval4d::slicing
