#include "export/mesh/skeleton.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "export/mesh/marching.hpp"

namespace oval4d::exports {

namespace {

/// A capsule: all points within `radius` of the line from `from` to `to`. This is a bar with round ends or, if both
/// ends are equal, a ball.
struct Capsule {
    glm::dvec3 from, to;
    double radius;

    /// Returns the distance from `place` to the capsule's surface; negative inside the capsule.
    double distance(const glm::dvec3& place) const {
        const glm::dvec3 along = to - from;
        const double squared = glm::dot(along, along);
        const double t = squared > 0 ? std::clamp(glm::dot(place - from, along) / squared, 0.0, 1.0) : 0;
        return glm::distance(place, from + t * along) - radius;
    }
};

/// Adds a capsule to a field of distances. At each point near the capsule, the value becomes Capsule::distance(), if
/// this is less than the old value. Points near the capsule include all corners of each cube with a corner inside the
/// capsule.
void addCapsule(const Capsule& capsule, SampledField& field) {
    const double reach = capsule.radius + 1.01 * std::sqrt(3) * field.step();
    const glm::ivec3 least = field.floorIndex(glm::min(capsule.from, capsule.to) - reach);
    const glm::ivec3 most = field.floorIndex(glm::max(capsule.from, capsule.to) + reach) + 1;
    // Visit the lines of points along x and, on each line, only the points near the capsule.
    const glm::dvec3 along = capsule.to - capsule.from;
    for (int k = least.z; k <= most.z; ++k) {
        for (int j = least.y; j <= most.y; ++j) {
            const glm::dvec3 row = field.positionOf({0, j, k});
            // Find the part of the capsule's axis near the line `row`, from the fraction `low` to the fraction `high`:
            // the part where y and z differ by at most `reach` from those of the line.
            double low = 0;
            double high = 1;
            for (const int axis : {1, 2}) {
                const double from = row[axis] - reach - capsule.from[axis];
                const double to = row[axis] + reach - capsule.from[axis];
                if (std::abs(along[axis]) < 1e-12) {
                    if (from > 0 || to < 0) high = -1;
                    continue;
                }
                low = std::max(low, std::min(from / along[axis], to / along[axis]));
                high = std::min(high, std::max(from / along[axis], to / along[axis]));
            }
            if (low > high) continue;
            const double x0 = capsule.from.x + low * along.x;
            const double x1 = capsule.from.x + high * along.x;
            const int first = field.floorIndex({std::min(x0, x1) - reach, 0, 0}).x;
            const int last = field.floorIndex({std::max(x0, x1) + reach, 0, 0}).x + 1;
            for (int i = first; i <= last; ++i) {
                const double distance = capsule.distance(field.positionOf({i, j, k}));
                if (distance > reach - capsule.radius) continue;
                float& value = field[{i, j, k}];
                value = std::min(value, static_cast<float>(distance));
            }
        }
    }
}

std::vector<Capsule> capsulesOf(const slicing::SliceSet& slices, int i, double scale, const SkeletonRadii& radii) {
    const glm::dvec3* points = slices.vertices.data() + slices.vertexBegin[i];
    std::vector<Capsule> capsules;
    for (std::size_t v = 0; v < slices.vertexCount(i); ++v) {
        if (slices.hasBall(slices.vertexBegin[i] + v))
            capsules.push_back({points[v] * scale, points[v] * scale, radii.ball});
    }
    for (std::uint32_t e = slices.edgeBegin[i]; e < slices.edgeBegin[i + 1]; ++e) {
        const auto [a, b] = slices.edges[e];
        capsules.push_back({points[a] * scale, points[b] * scale, radii.bar});
    }
    return capsules;
}

}  // namespace

SkeletonRadii skeletonRadii(const scene::Scene& scene, double scale) {
    return {scene.ballRadius / scene.scale * scale, scene.barRadius / scene.scale * scale};
}

double estimateSkeletonTriangles(const slicing::SliceSet& slices, double scale, const SkeletonRadii& radii) {
    double area = 0;
    for (std::size_t v = 0; v < slices.vertices.size(); ++v)
        area += slices.hasBall(v) ? 4 * std::numbers::pi * radii.ball * radii.ball : 0;
    for (int i = 0; i < slices.planes.count; ++i) {
        const glm::dvec3* points = slices.vertices.data() + slices.vertexBegin[i];
        for (std::uint32_t e = slices.edgeBegin[i]; e < slices.edgeBegin[i + 1]; ++e) {
            const double length = scale * glm::distance(points[slices.edges[e][0]], points[slices.edges[e][1]]);
            area += 2 * std::numbers::pi * radii.bar * std::max(0.0, length - 2 * radii.ball);
        }
    }
    constexpr double kPerSquare = 9;  // measured number of triangles on an area of radii.bar²
    return kPerSquare * area / (radii.bar * radii.bar);
}

Mesh skeletonOf(const slicing::SliceSet& slices, int i, double scale, const SkeletonRadii& radii, double cube,
                const RoundingGrid& grid, const ExportBudget& budget) {
    // The offset of the field's origin keeps the points of the field off the symmetry planes of the polytope. On these
    // planes, many values could be exactly 0, and triangles with corners there would degenerate.
    SampledField field(glm::dvec3(0.371, 0.217, 0.449) * cube, cube);
    for (const Capsule& capsule : capsulesOf(slices, i, scale, radii)) {
        budget.checkTimeAndStop();
        addCapsule(capsule, field);
    }
    return marchTetrahedra(field, linearCrossingFinder(field), grid, budget);
}

}  // namespace oval4d::exports
