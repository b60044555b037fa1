#include "export/arrangement.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "scene/scene.hpp"

namespace oval4d::exports {

namespace {

double gapBetweenBodies(double size) { return std::max(size / 12, 2.0); }

BoundingBox boundingBoxOf(const SliceBodies& group) {
    BoundingBox box;
    for (const PlacedMesh& solid : group.bodies) {
        const BoundingBox own = exports::boundingBoxOf(solid.mesh);
        box.include(own.min + solid.at);
        box.include(own.max + solid.at);
    }
    return box;
}

void translateBodies(SliceBodies& group, const glm::dvec3& by, const RoundingGrid& grid) {
    for (PlacedMesh& solid : group.bodies) solid.at += grid.snap(by);
}

}  // namespace

void arrangeOnPlate(std::vector<SliceBodies>& groups, double size, const RoundingGrid& grid) {
    const auto perRow = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(groups.size()))));
    const double gap = gapBetweenBodies(size);
    double y = 0;
    for (std::size_t row = 0; row < groups.size(); row += perRow) {
        double x = 0;
        double depth = 0;
        for (std::size_t i = row; i < std::min(row + perRow, groups.size()); ++i) {
            const BoundingBox box = boundingBoxOf(groups[i]);
            translateBodies(groups[i], glm::dvec3(x, y, 0) - box.min, grid);
            x += box.size().x + gap;
            depth = std::max(depth, box.size().y);
        }
        y += depth + gap;
    }
}

void arrangeInOval(std::vector<SliceBodies>& groups, const scene::Scene& scene, double size, const RoundingGrid& grid) {
    const double perWorld = size / 2 / (scene.scale * scene.circumradius);  // millimeters per world unit
    std::vector<glm::dvec3> places;
    std::vector<double> radii;
    for (const SliceBodies& group : groups) {
        places.push_back(scene.placements[group.slice].position * perWorld);
        const BoundingBox box = boundingBoxOf(group);
        radii.push_back(std::max(glm::length(box.min), glm::length(box.max)));
    }
    double grow = 1;
    for (std::size_t i = 0; i < groups.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            grow = std::max(grow, (radii[i] + radii[j]) / glm::distance(places[i], places[j]));
        }
    }
    for (std::size_t i = 0; i < groups.size(); ++i) translateBodies(groups[i], places[i] * grow, grid);
}

double coordinateBound(int slices, double size) {
    const double onPlate = std::ceil(std::sqrt(slices)) * (size + gapBetweenBodies(size)) * 1.5;
    // Neighboring slices are at least about `size` apart, so beyond 21 slices, the oval grows in proportion to their
    // number.
    const double inOval = 60.0 * size * std::max(1.0, slices / 21.0);
    return std::max(onPlate, inOval);
}

}  // namespace oval4d::exports
