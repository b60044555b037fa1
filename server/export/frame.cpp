#include "export/frame.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "export/marching.hpp"
#include "scene/scene.hpp"

namespace oval4d::exports {

namespace {

/// A bar with round ends, or a ball where both ends are one.
struct Rod {
    glm::dvec3 from, to;
    double radius;

    double distance(const glm::dvec3& place) const {
        const glm::dvec3 along = to - from;
        const double squared = glm::dot(along, along);
        const double t = squared > 0 ? std::clamp(glm::dot(place - from, along) / squared, 0.0, 1.0) : 0;
        return glm::distance(place, from + t * along) - radius;
    }
};

/// Lowers the field to the rod's distance at all points that are inside or share a cube with one that is.
void include(const Rod& rod, SampledField& field) {
    const double reach = rod.radius + 1.01 * std::sqrt(3) * field.step();
    const glm::ivec3 least = field.below(glm::min(rod.from, rod.to) - reach);
    const glm::ivec3 most = field.below(glm::max(rod.from, rod.to) + reach) + 1;
    // Line by line along x: there the points near the rod are those near where it passes.
    const glm::dvec3 along = rod.to - rod.from;
    for (int k = least.z; k <= most.z; ++k) {
        for (int j = least.y; j <= most.y; ++j) {
            const glm::dvec3 row = field.place({0, j, k});
            // The part of the rod whose y and z are within reach of this line.
            double low = 0;
            double high = 1;
            for (const int axis : {1, 2}) {
                const double from = row[axis] - reach - rod.from[axis];
                const double to = row[axis] + reach - rod.from[axis];
                if (std::abs(along[axis]) < 1e-12) {
                    if (from > 0 || to < 0) high = -1;
                    continue;
                }
                low = std::max(low, std::min(from / along[axis], to / along[axis]));
                high = std::min(high, std::max(from / along[axis], to / along[axis]));
            }
            if (low > high) continue;
            const double x0 = rod.from.x + low * along.x;
            const double x1 = rod.from.x + high * along.x;
            const int first = field.below({std::min(x0, x1) - reach, 0, 0}).x;
            const int last = field.below({std::max(x0, x1) + reach, 0, 0}).x + 1;
            for (int i = first; i <= last; ++i) {
                const double distance = rod.distance(field.place({i, j, k}));
                if (distance > reach - rod.radius) continue;
                float& value = field.at({i, j, k});
                value = std::min(value, static_cast<float>(distance));
            }
        }
    }
}

std::vector<Rod> rodsOf(const geometry::SliceSet& slices, int i, double scale, const Thickness& thickness) {
    const glm::dvec3* points = slices.vertices.data() + slices.vertexBegin[i];
    std::vector<Rod> rods;
    for (std::size_t v = 0; v < slices.vertexCount(i); ++v)
        rods.push_back({points[v] * scale, points[v] * scale, thickness.ball});
    for (std::uint32_t e = slices.edgeBegin[i]; e < slices.edgeBegin[i + 1]; ++e) {
        const auto [a, b] = slices.edges[e];
        rods.push_back({points[a] * scale, points[b] * scale, thickness.bar});
    }
    return rods;
}

}  // namespace

Thickness thicknessFor(const geometry::Polytope& polytope, double scale) {
    scene::Look look;
    look.view = scene::View::single;
    scene::Scene scene;
    scene::compose(polytope, {0, 1, 1}, 0, look, {}, scene);
    return {scene.ballRadius / scene.scale * scale, scene.barRadius / scene.scale * scale};
}

double coarseTriangles(const geometry::SliceSet& slices, double scale, const Thickness& thickness) {
    double area = 4 * std::numbers::pi * thickness.ball * thickness.ball * static_cast<double>(slices.vertices.size());
    for (int i = 0; i < slices.planes.count; ++i) {
        const glm::dvec3* points = slices.vertices.data() + slices.vertexBegin[i];
        for (std::uint32_t e = slices.edgeBegin[i]; e < slices.edgeBegin[i + 1]; ++e) {
            const double length = scale * glm::distance(points[slices.edges[e][0]], points[slices.edges[e][1]]);
            area += 2 * std::numbers::pi * thickness.bar * std::max(0.0, length - 2 * thickness.ball);
        }
    }
    constexpr double kPerSquare = 9;  // measured
    return kPerSquare * area / (thickness.bar * thickness.bar);
}

Mesh frameOf(const geometry::SliceSet& slices, int i, double scale, const Thickness& thickness, double cube,
             const Grid& grid, const Budget& budget) {
    // Off the symmetric places of polytopes, where many values would be equal.
    SampledField field(glm::dvec3(0.371, 0.217, 0.449) * cube, cube);
    for (const Rod& rod : rodsOf(slices, i, scale, thickness)) {
        budget.checkTime();
        include(rod, field);
    }
    return march(field, linearCrossing(field), grid, budget);
}

}  // namespace oval4d::exports
