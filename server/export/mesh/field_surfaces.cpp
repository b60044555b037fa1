#include "export/mesh/field_surfaces.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

#include <glm/geometric.hpp>

#include "slicing/slice_set.hpp"
#include "slicing/surfaces/section_values.hpp"

namespace oval4d::exports {

namespace {

std::vector<std::size_t> allLevelIndices(const scene::Scene& scene) {
    std::vector<std::size_t> levels(scene.look.field.levels.size());
    std::iota(levels.begin(), levels.end(), std::size_t{0});
    return levels;
}

}  // namespace

FieldSurfaceSource::FieldSurfaceSource(const scene::Scene& scene, const fields::Field& field,
                                       const geometry::Rotation& orientation, bool exact,
                                       std::vector<std::size_t> levels, const ExportBudget& budget)
    : scene_(scene), field_(field), orientation_(orientation), levels_(std::move(levels)) {
    if (!exact) return;
    slicer_.emplace(
        field, orientation_,
        ExactFieldSlicer::SurfaceOptions{
            .inside = scene.look.field.inside, .pointData = true, .advice = "; export fewer slices, or without exact"},
        budget);
}

FieldSurfaceSource::FieldSurfaceSource(const scene::Scene& scene, const fields::Field& field,
                                       const geometry::Rotation& orientation, bool exact, const ExportBudget& budget)
    : FieldSurfaceSource(scene, field, orientation, exact, allLevelIndices(scene), budget) {}

FieldSliceSurface FieldSurfaceSource::surfaceOfSlice(int i) {
    if (!slicer_) return {scene_.slices->surfaces[static_cast<std::size_t>(i)], {}};
    surface_.clear();
    points_.clear();
    const double w = scene_.slices->planes.w(i);
    for (const std::size_t level : levels_) {
        slicer_->slice(w, scene_.look.field.levels[level], triangles_, closed_);
        triangles_ += closed_.triangles.size();
        appendLevelSurface(level);
    }
    if (field_.second) {
        slicing::placeSection(field_, field_.toFunction * orientation_.inverse().matrix(), w, section_);
        slicing::evaluateInSection(*field_.second->function, section_, std::span(std::as_const(points_)),
                                   surface_.secondValues);
        field_.second->function->releasePages();
    }
    field_.requireReadable();
    return {surface_, points_};
}

// Appends the surface of one level, which is in closed_, to surface_.
void FieldSurfaceSource::appendLevelSurface(std::size_t level) {
    const auto first = static_cast<std::uint32_t>(points_.size());
    const double sign = scene_.look.field.inside == fields::BodySide::below ? 1 : -1;
    for (std::size_t p = 0; p < closed_.points.size(); ++p) {
        const glm::dvec4& gradient = closed_.gradients[p];
        const glm::dvec3 slope(gradient);
        const double length = glm::length(slope);
        const bool valid = length > 0 && std::isfinite(length);
        points_.push_back(closed_.points[p]);
        surface_.points.emplace_back(closed_.points[p]);
        surface_.normals.emplace_back(valid ? slope * (sign / length) : glm::dvec3(0, 0, 1));
        surface_.growth.push_back(valid ? static_cast<float>(-sign * gradient.w / length)
                                        : std::numeric_limits<float>::infinity());
        surface_.values.push_back(closed_.values[p]);
    }
    for (std::size_t t = 0; t < closed_.triangles.size(); ++t) {
        const auto& [a, b, c] = closed_.triangles[t];
        surface_.triangles.push_back({first + a, first + b, first + c});
        const std::size_t cap = t < closed_.firstCap ? 0 : slicing::SliceSurface::kCap;
        surface_.levelAndCap.push_back(static_cast<std::uint8_t>(level | cap));
    }
}

}  // namespace oval4d::exports
