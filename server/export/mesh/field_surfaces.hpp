#pragma once
// The surfaces in the slices of a field, for an exported file.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "export/budget.hpp"
#include "export/mesh/exact_slicer.hpp"
#include "fields/field.hpp"
#include "geometry/rotation.hpp"
#include "scene/scene.hpp"
#include "slicing/closed_surfaces/closed_surface.hpp"
#include "slicing/surfaces/field_section.hpp"
#include "slicing/surfaces/slice_surface.hpp"

namespace oval4d::exports {

/// The surface (of all levels) in one slice of a field.
struct FieldSliceSurface {
    const slicing::SliceSurface& surface;
    std::span<const glm::dvec3> exactPoints;  ///< points of `surface` as 64-bit floats; empty if they are unknown

    glm::dvec3 point(std::size_t i) const {
        return exactPoints.empty() ? glm::dvec3(surface.points[i]) : exactPoints[i];
    }
};

/// A source of the surfaces in the slices of a field. The surfaces are those of a scene, or exact surfaces, which are
/// made when they are needed (see ExactFieldSlicer). The normal and the growth at a point of an exact surface are
/// computed from the gradient there.
class FieldSurfaceSource {
  public:
    /// The slices of `scene` must have been cut from `field` rotated by `orientation`. If `exact` is false, they must
    /// have surfaces (SliceSet::surfaces). If `exact` is true, `levels` are the needed levels, as ascending indices in
    /// FieldSettings::levels; otherwise, `levels` is ignored. `scene`, `field` and `budget` must outlive this object.
    FieldSurfaceSource(const scene::Scene& scene, const fields::Field& field, const geometry::Rotation& orientation,
                       bool exact, std::vector<std::size_t> levels, const ExportBudget& budget);
    /// Does the same as the constructor above, with all levels of the field.
    FieldSurfaceSource(const scene::Scene& scene, const fields::Field& field, const geometry::Rotation& orientation,
                       bool exact, const ExportBudget& budget);

    /// Returns the surface of slice i, which is valid until the next call. The limits on triangles and memory apply to
    /// all surfaces so far together. Throws ExportRefused if a limit is exceeded or a stop was requested. Throws
    /// std::runtime_error if the samples of the field are in a file that can no longer be read.
    FieldSliceSurface surfaceOfSlice(int i);

  private:
    void appendLevelSurface(std::size_t level);

    const scene::Scene& scene_;
    const fields::Field& field_;
    const geometry::Rotation orientation_;
    const std::vector<std::size_t> levels_;
    std::optional<ExactFieldSlicer>
        slicer_;                     // the slicer of exact surfaces; empty if the surfaces are those of the scene
    slicing::ClosedSurface closed_;  // the exact surface of one level
    slicing::SliceSurface surface_;  // the exact surfaces of all levels_
    std::vector<glm::dvec3> points_;
    slicing::FieldSection section_;
    std::size_t triangles_ = 0;  // number of triangles of all exact surfaces so far
};

}  // namespace oval4d::exports
