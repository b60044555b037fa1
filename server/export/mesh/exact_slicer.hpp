#pragma once
// Exact slices of fields, within the limits on an export.

#include <cstddef>
#include <string>

#include "export/budget.hpp"
#include "fields/field.hpp"
#include "fields/inside.hpp"
#include "geometry/rotation.hpp"
#include "slicing/closed_surfaces/closed_surface.hpp"
#include "slicing/closed_surfaces/closed_surface_slicer.hpp"

namespace oval4d::exports {

/// A slicer that slices a field exactly (see slicing::ClosedSurfaceSlicer). A formula is sampled on its default
/// lattice.
class ExactFieldSlicer {
  public:
    struct SurfaceOptions {
        fields::BodySide inside = fields::BodySide::below;
        bool pointData = false;  ///< whether to compute the function's value and gradient at each point
        /// What the user can do about too many triangles, as the end of the error message. Empty, or begins with a
        /// semicolon.
        std::string advice = {};
    };

    /// `field` and `budget` must outlive this object. Throws ExportRefused if there is no memory for the tables of the
    /// slicer.
    ExactFieldSlicer(const fields::Field& field, const geometry::Rotation& orientation, SurfaceOptions options,
                     const ExportBudget& budget);

    /// Slices the body of one level (isovalue) by the hyperplane at `w`. Overwrites `out`. `others` is the number of
    /// triangles that the export has made before; the limits apply to all triangles together. Throws ExportRefused if a
    /// limit is exceeded or a stop was requested. Releases the pages of the field's file afterward.
    void slice(double w, double level, std::size_t others, slicing::ClosedSurface& out);

  private:
    const fields::Field& field_;
    const ExportBudget& budget_;
    const SurfaceOptions options_;
    slicing::ClosedSurfaceSlicer slicer_;
};

}  // namespace oval4d::exports
