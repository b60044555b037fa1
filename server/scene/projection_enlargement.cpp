#include "scene/projection_enlargement.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace oval4d::scene {

namespace {

// Returns the radius of a sphere about the origin that contains the vertices `first` … `end` − 1 of `set` with their
// balls. `scale` is the number of world units per unit of the object. `ballRadius` and the result are in world units.
double boundingRadius(const slicing::SliceSet& set, std::size_t first, std::size_t end, double scale,
                      double ballRadius) {
    double reach = 0;
    for (std::size_t v = first; v < end; ++v) {
        const double own = set.ballScale.empty() ? 1 : set.ballScale[v];
        reach = std::max(reach, scale * glm::length(set.vertices[v]) + ballRadius * own);
    }
    return reach;
}

// Returns half the angle that a sphere fills in the view from the distance `distance` from its center. Returns π if the
// eye is inside the sphere.
double halfAngleOf(double radius, double distance) {
    return radius < distance ? std::asin(radius / distance) : std::numbers::pi;
}

}  // namespace

double enlargementBehindSlices(const Scene& scene) {
    const slicing::SliceSet &slices = *scene.slices, &elements = scene.projection.elements;
    double thickest = 0;
    for (const ProjectionPartLook& look : scene.projection.parts)
        thickest = std::max({thickest, look.ballRadius, look.barRadius});
    const double reach = boundingRadius(elements, 0, elements.vertices.size(), scene.projection.scale, thickest);
    const glm::dvec3 toProjection = scene.projectionPlacement.position - scene.camera.eye;
    const double distance = glm::length(toProjection);
    const double nearest = std::max(distance - reach, scene.camera.near);
    double factor = 1;
    for (std::size_t i = 0; i < scene.placements.size(); ++i) {
        const std::size_t first = slices.vertexBegin[i], end = slices.vertexBegin[i + 1];
        if (!scene.placements[i].drawn || first == end) continue;
        const double ball = std::max(scene.drawnBallRadius(), scene.barRadius);
        const double sliceReach = boundingRadius(slices, first, end, scene.scale, ball);
        const glm::dvec3 toSlice = scene.placements[i].position - scene.camera.eye;
        const double sliceDistance = glm::length(toSlice);
        const double cosine = glm::dot(toSlice, toProjection) / (sliceDistance * distance);
        const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
        if (angle > halfAngleOf(sliceReach, sliceDistance) + halfAngleOf(reach, distance)) continue;
        factor = std::max(factor, (sliceDistance + sliceReach) / nearest);
    }
    return factor;
}

}  // namespace oval4d::scene
