#pragma once
// Exports slices, projections and drawings to files for other programs.

#include <stop_token>
#include <string>
#include <variant>
#include <vector>

#include "export/budget.hpp"
#include "export/export_request.hpp"
#include "geometry/rotation.hpp"
#include "scene/scene.hpp"
#include "slicing/object.hpp"

namespace oval4d::exports {

/// An exported file.
struct ExportedFile {
    std::string bytes;
    /// What the user may miss in the file: slices without a body, and labels without room. Each warning is an ASCII
    /// text without semicolons and without a full stop.
    std::vector<std::string> warnings;
};

/// Returns a file with the slices of `scene` or with a drawing of it. The slices must have been cut from `object`
/// rotated by `orientation`. For ExportContents::focus, `scene` must contain only the focus slice; for
/// ExportContents::oval, it must be laid out for the oval view. For ExportContents::highlight, its Look::highlight must
/// be the element to export, and its only slice must be slicing::shapeOf() this element. For
/// ExportContents::projection, drawings require a scene that shows the projection; bodies require a scene whose only
/// slice is the projection. For ExportContents::matrix, the scene must show the matrix. For the solid bodies of a
/// field, except a highlighted cell of its box, and for formats with Format::takesSurfaces, the slice set must contain
/// the surfaces (SliceSet::surfaces).
///
/// Bodies are in millimeters (in GLB and X3D in meters, as these formats require), closed and 2-manifold: every edge
/// belongs to exactly two triangles that traverse it in opposite directions, and normals point outward.
///
/// Returns an error if a limit is exceeded, if there is nothing to export, if the format cannot contain what is asked,
/// or if a stop is requested. Throws std::runtime_error if a library that writes the file fails, or if the font of a
/// label cannot be read.
std::variant<ExportedFile, ExportError> exportScene(const scene::Scene& scene, const slicing::Object& object,
                                                    const geometry::Rotation& orientation, const ExportRequest& request,
                                                    const ExportLimits& limits, std::stop_token stop = {});

}  // namespace oval4d::exports
