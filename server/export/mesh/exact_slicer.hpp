#pragma once
// Exact slices of fields, within the limits of an export.

#include <cstddef>
#include <string>

#include "export/budget.hpp"
#include "fields/field.hpp"
#include "fields/inside.hpp"
#include "geometry/rotation.hpp"
#include "slicing/closed_surfaces/closed_surface.hpp"
#include "slicing/closed_surfaces/closed_surface_slicer.hpp"

namespace oval4d::exports {

/// Slices a field exactly: see slicing::ClosedSurfaceSlicer. A formula is sampled on its default lattice.
class ExactSlicer {
  public:
    struct SurfaceOptions {
        fields::Inside inside = fields::Inside::below;
        bool pointData = false;  ///< see slicing::ClosedSurfaceSlicer::IsosurfaceOptions
        /// The end of the error message about too many triangles: what the user can do. Empty, or begins with a
        /// semicolon.
        std::string advice = {};
    };

    /// `field` and `budget` must outlive this object. Throws ExportRefused if the memory limit leaves no room for the
    /// tables of the slicer.
    ExactSlicer(const fields::Field& field, const geometry::Rotation& orientation, SurfaceOptions options,
                const Budget& budget);

    /// Slices the body of one level by the hyperplane at `w`. Overwrites `out`. `others` is the number of triangles
    /// that the export has made before; the limits apply to these and the new triangles together. Throws ExportRefused
    /// if a limit is exceeded or a stop is requested. Afterward, the pages of the field's file are released.
    void slice(double w, double level, std::size_t others, slicing::ClosedSurface& out);

  private:
    const fields::Field& field_;
    const Budget& budget_;
    const SurfaceOptions options_;
    slicing::ClosedSurfaceSlicer slicer_;
};

}  // namespace oval4d::exports
