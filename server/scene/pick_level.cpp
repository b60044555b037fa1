#include "scene/pick_level.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include "slicing/surfaces/field_section.hpp"
#include "slicing/surfaces/section_values.hpp"

namespace oval4d::scene {

namespace {

// The part of the ray through a pixel that lies in one slice, shown at its own place or in the projection. The points
// of the ray are start + depth · direction, in the units of the object.
struct SliceRay {
    PickLocation in = PickLocation::slice;
    std::size_t slice = 0;
    glm::dvec3 start{0}, direction{0};
    double entry = 0, exit = 0;  // the depths between which the ray is in the box of the field
    // Whether the ray enters the box at `entry`. If false, the box begins nearer to the eye than Camera::near.
    bool beginsAtWall = false;
};

// Finds the surface at a pixel by casting the ray through this pixel.
class RayCaster {
  public:
    RayCaster(const Scene& scene, const fields::Field& field, const geometry::Rotation& orientation, glm::dvec2 point)
        : scene_(scene), field_(field), toFunction_(field.toFunction * orientation.inverse().matrix()) {
        direction_ = glm::transpose(glm::dmat3(scene.camera.view())) * viewRayThrough(scene, point);
    }

    // Finds the nearest point of a surface that `element` does not hide. Searches the slices first and then, if they
    // show no such point, the projection.
    std::optional<PickedLevel> nearestLevelInFrontOf(const std::optional<PickedElement>& element) {
        constexpr double kInf = std::numeric_limits<double>::infinity();
        const bool isElementInProjection = element && element->in == PickLocation::projection;
        std::vector<SliceRay> rays;
        const auto addRay = [&](PickLocation in, std::size_t slice, const glm::dvec3& position, double scale) {
            if (!scene_.placements[slice].drawn) return;
            placeSection(slice);
            if (const auto ray = rayThroughSlice(in, slice, position, scale)) rays.push_back(*ray);
        };
        for (std::size_t i = 0; i < scene_.placements.size(); ++i)
            addRay(PickLocation::slice, i, scene_.placements[i].position, scene_.scale);
        std::ranges::sort(rays, {}, &SliceRay::entry);
        castRays(rays, element && !isElementInProjection ? element->depth : kInf);
        const auto& focus = scene_.projection.focusSurface;
        if (!found_ && (!element || isElementInProjection) && scene_.projectionPlacement.shown && focus) {
            rays.clear();
            addRay(PickLocation::projection, focus->slice, scene_.projectionPlacement.position, focus->scale);
            castRays(rays, element ? element->depth : kInf);
        }
        field_.function->releasePages();
        field_.requireReadable();
        return found_;
    }

  private:
    // A point of a ray at which the ray enters or leaves the body of a level.
    struct LevelCrossing {
        double depth;
        bool cap;
    };

    // Finds the nearest point of a surface on the rays, at a depth less than `depth`. The rays are sorted by the depth
    // at which they enter the box of the field.
    void castRays(const std::vector<SliceRay>& rays, double depth) {
        nearest_ = depth;
        for (const SliceRay& ray : rays) {
            if (ray.entry >= nearest_) break;
            placeSection(ray.slice);
            castRay(ray);
        }
    }

    void placeSection(std::size_t slice) {
        slicing::placeSection(field_, toFunction_, scene_.placements[slice].w, section_);
    }

    // Returns the part of the ray in the slice whose section placeSection() has placed last. Returns an empty optional
    // if the ray misses the box of the field. `position` and `scale` map the units of the object to world space.
    std::optional<SliceRay> rayThroughSlice(PickLocation in, std::size_t slice, const glm::dvec3& position,
                                            double scale) const {
        SliceRay ray;
        ray.in = in;
        ray.slice = slice;
        ray.start = (scene_.camera.eye - position) / scale;
        ray.direction = direction_ / scale;
        const glm::dvec4 start = section_.origin + directionInFunction(ray.start),
                         along = directionInFunction(ray.direction);
        ray.entry = -std::numeric_limits<double>::infinity();
        ray.exit = scene_.camera.far;
        for (int axis = 0; axis < 4; ++axis) {
            const double least = field_.box.min[axis], most = field_.box.max[axis];
            if (along[axis] == 0) {
                if (start[axis] < least || start[axis] > most) return std::nullopt;
                continue;
            }
            const double toLeast = (least - start[axis]) / along[axis], toMost = (most - start[axis]) / along[axis];
            ray.entry = std::max(ray.entry, std::min(toLeast, toMost));
            ray.exit = std::min(ray.exit, std::max(toLeast, toMost));
        }
        ray.beginsAtWall = ray.entry >= scene_.camera.near;
        ray.entry = std::max(ray.entry, scene_.camera.near);
        if (!(ray.entry < ray.exit)) return std::nullopt;
        return ray;
    }
    glm::dvec4 directionInFunction(const glm::dvec3& v) const {
        return v.x * section_.axes[0] + v.y * section_.axes[1] + v.z * section_.axes[2];
    }

    // Finds the first point of a surface on the ray. Keeps the point if it is nearer than nearest_.
    void castRay(const SliceRay& ray) {
        // The intended time to evaluate all rays through the slices together, in nanoseconds.
        constexpr double kTime = 1.5e8;
        const double affordable =
            kTime / (static_cast<double>(scene_.placements.size()) * std::max(field_.function->cost().value, 1.0));
        const double perDiameter = std::clamp(affordable, kMinRaySamples, kRaySamples);
        const double length = (ray.exit - ray.entry) * glm::length(ray.direction);
        const auto steps = static_cast<std::size_t>(
            std::clamp(std::ceil(perDiameter * length / (2 * scene_.circumradius)), 2.0, perDiameter));
        evaluateAlongRay(ray, ray.entry, ray.exit, steps);
        const std::vector<float> values = values_;  // a copy, because evaluateAlongRay() overwrites values_
        const auto depthAt = [&](std::size_t k) {
            return std::lerp(ray.entry, ray.exit, static_cast<double>(k) / static_cast<double>(steps));
        };
        for (const SurfaceLook::LevelLook& level : scene_.surfaces.levels) {
            if (level.caps && ray.beginsAtWall && isInside(values[0], level))
                keepIfNearest(ray, level, {ray.entry, true});
        }
        for (std::size_t k = 0; k < steps && depthAt(k) < nearest_; ++k) {
            for (const SurfaceLook::LevelLook& level : scene_.surfaces.levels) {
                if (isInside(values[k], level) == isInside(values[k + 1], level)) continue;
                const LevelCrossing crossing = refineCrossing(ray, level, depthAt(k), depthAt(k + 1));
                if (!crossing.cap || level.caps) keepIfNearest(ray, level, crossing);
            }
        }
    }

    // Finds the first place between the depths `from` and `to` at which the ray enters or leaves the body of a level.
    // There must be such a place.
    LevelCrossing refineCrossing(const SliceRay& ray, const SurfaceLook::LevelLook& level, double from, double to) {
        constexpr std::size_t kSteps = 32, kRounds = 5;
        bool cap = false, entering = false;
        for (std::size_t round = 0; round < kRounds; ++round) {
            evaluateAlongRay(ray, from, to, kSteps);
            const bool before = isInside(values_[0], level);
            std::size_t k = 0;
            while (k + 1 < kSteps && isInside(values_[k + 1], level) == before) ++k;
            cap = std::isnan(values_[k]) || std::isnan(values_[k + 1]);
            entering = !before;
            const double step = (to - from) / kSteps, begin = from;
            from = begin + static_cast<double>(k) * step;
            to = begin + static_cast<double>(k + 1) * step;
        }
        // A point of a cap is placed inside the body, where the function has a value.
        return {cap ? (entering ? to : from) : (from + to) / 2, cap};
    }

    void keepIfNearest(const SliceRay& ray, const SurfaceLook::LevelLook& level, const LevelCrossing& crossing) {
        if (crossing.depth >= nearest_) return;
        nearest_ = crossing.depth;
        const glm::dvec3 p = ray.start + crossing.depth * ray.direction;
        found_ = {level.index, crossing.cap, ray.in, ray.slice, glm::dvec4(p, scene_.placements[ray.slice].w)};
    }

    bool isInside(float value, const SurfaceLook::LevelLook& look) const {
        const double level = scene_.look.field.levels[look.index];
        return scene_.look.field.inside == fields::BodySide::below ? value < level : value > level;
    }

    // Sets values_ to the values of the function at steps + 1 points of the ray between the depths `from` and `to`.
    void evaluateAlongRay(const SliceRay& ray, double from, double to, std::size_t steps) {
        points_.clear();
        for (std::size_t k = 0; k <= steps; ++k) {
            const double depth = std::lerp(from, to, static_cast<double>(k) / static_cast<double>(steps));
            points_.push_back(ray.start + depth * ray.direction);
        }
        slicing::evaluateInSection(*field_.function, section_, std::span<const glm::dvec3>(points_), values_);
    }

    const Scene& scene_;
    const fields::Field& field_;
    const glm::dmat4 toFunction_;
    // The direction of the ray from the eye, in world space; its length corresponds to a depth of 1.
    glm::dvec3 direction_{0};
    slicing::FieldSection section_;  // the hyperplane of the current slice; `walls`, `min` and `max` are not set
    std::vector<glm::dvec3> points_;
    std::vector<float> values_;
    double nearest_ = 0;  // the depth of the point in found_
    std::optional<PickedLevel> found_;
};

// Returns the point of the line segment from `from` to `to` that is nearest to the origin.
glm::dvec2 nearestToOrigin(const glm::dvec2& from, const glm::dvec2& to) {
    const glm::dvec2 along = to - from;
    const double length = glm::dot(along, along);
    return from + (length > 0 ? std::clamp(-glm::dot(from, along) / length, 0.0, 1.0) : 0.0) * along;
}

// Finds the contour at a pixel of a panel of the matrix. `shown` is the 4-D point that the panel shows at this pixel.
std::optional<PickedLevel> pickContour(const Scene& scene, glm::dvec2 point, const glm::dvec4& shown) {
    const double height = scene.viewport.height;
    const auto [row, column] = *scene.matrix.panelAt({point.x / height, 1 - point.y / height});
    const std::array<int, 2> axes{std::min(row, column), std::max(row, column)};
    const auto plane = std::ranges::find(slicing::kPlaneAxes, axes) - slicing::kPlaneAxes.begin();
    const slicing::PlanarContours& contours = scene.sectionMatrix.contours.at(static_cast<std::size_t>(plane));
    const glm::dvec2 at(shown[axes[0]], shown[axes[1]]);
    // The length of one unit of the object in the panel, in pixels.
    const double pixels = scene.matrix.panelScale(scene.circumradius) * height;
    double nearest = std::max(scene.matrix.lineWidth / 2 * height, kHitRadius) / pixels;
    std::optional<PickedLevel> found;
    for (std::size_t i = 0; i < contours.lineCount(); ++i) {
        const std::span<const glm::dvec2> line = contours.line(i);
        for (std::size_t k = 0; k + 1 < line.size(); ++k) {
            const glm::dvec2 offset = nearestToOrigin(line[k] - at, line[k + 1] - at);
            if (glm::length(offset) > nearest) continue;
            nearest = glm::length(offset);
            found = {contours.level[i], false, PickLocation::matrix, 0, scene.sectionMatrix.point};
            found->point[axes[0]] = at.x + offset.x;
            found->point[axes[1]] = at.y + offset.y;
        }
    }
    return found;
}

}  // namespace

std::optional<PickedLevel> pickLevel(const Scene& scene, const fields::Field& field,
                                     const geometry::Rotation& orientation, glm::dvec2 point,
                                     const std::optional<PickedElement>& element) {
    if (scene.surfaces.empty()) return std::nullopt;
    const bool isElementInSpace =
        element && (element->in == PickLocation::slice || element->in == PickLocation::projection);
    if (element && !isElementInSpace) return std::nullopt;
    if (const auto shown = matrixPointAt(scene, point)) return pickContour(scene, point, *shown);
    if (isClearedOfSlices(scene, point)) return std::nullopt;
    return RayCaster(scene, field, orientation, point).nearestLevelInFrontOf(element);
}

}  // namespace oval4d::scene
