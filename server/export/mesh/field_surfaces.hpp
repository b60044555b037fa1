#pragma once
// The surfaces of the slices of a field that a file contains.

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

/// The surface in one slice of a field.
struct FieldSliceSurface {
    const slicing::SliceSurface& surface;
    std::span<const glm::dvec3> exactPoints;  ///< the points of `surface` before they were rounded; empty if unknown

    glm::dvec3 point(std::size_t i) const {
        return exactPoints.empty() ? glm::dvec3(surface.points[i]) : exactPoints[i];
    }
};

/// Returns the surfaces of the slices of a field one after another: either those of a scene or exact ones, which it
/// makes when they are needed (see ExactSlicer). The normals and the growth at the points of an exact surface are those
/// of the interpolated function: means over the triangles at the point.
class FieldSurfaceSource {
  public:
    /// The slices of `scene` must have been cut from `field` rotated by `orientation`. If `exact` is false, they must
    /// have surfaces (SliceSet::surfaces). `levels` are the indices in FieldSettings::levels, in ascending order, of
    /// those levels of which an exact surface is needed; it is ignored if `exact` is false. `scene`, `field` and
    /// `budget` must outlive this object.
    FieldSurfaceSource(const scene::Scene& scene, const fields::Field& field, const geometry::Rotation& orientation,
                       bool exact, std::vector<std::size_t> levels, const Budget& budget);
    /// The same, where `levels` are all levels of the field.
    FieldSurfaceSource(const scene::Scene& scene, const fields::Field& field, const geometry::Rotation& orientation,
                       bool exact, const Budget& budget);

    /// Returns the surface of slice i. The surface is valid until the next call. The limits on triangles and memory
    /// apply to the surfaces of all slices so far together. Throws ExportRefused if a limit is exceeded or a stop is
    /// requested, and std::runtime_error if the samples of the field are in a file that can no longer be read.
    FieldSliceSurface ofSlice(int i);

  private:
    void append(std::size_t level);

    const scene::Scene& scene_;
    const fields::Field& field_;
    const geometry::Rotation orientation_;
    const std::vector<std::size_t> levels_;
    std::optional<ExactSlicer> slicer_;  // empty unless the surfaces are exact
    slicing::ClosedSurface closed_;      // of one level
    slicing::SliceSurface surface_;      // of all levels_
    std::vector<glm::dvec3> points_;
    slicing::FieldSection section_;
    std::size_t triangles_ = 0;  // the number of triangles of all exact surfaces so far
};

}  // namespace oval4d::exports
