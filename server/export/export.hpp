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
    /// Texts for the user about what the file lacks: slices without a body, labels without room and so on. A warning
    /// contains no semicolon and does not end with a full stop. Its only character outside of ASCII is the minus sign
    /// U+2212.
    std::vector<std::string> warnings;
};

/// Returns a file with the slices of `scene` or with a drawing of it. The slices must have been cut from `object`
/// rotated by `orientation`. For some values of ExportRequest::contents, `scene` must meet a requirement:
/// - focus: it contains only the focus slice.
/// - oval: its view shows all slices (see scene::showsAllSlices()).
/// - highlight: its Look::highlight is the element to export, and its only slice is this element (see
///   slicing::writeElementAsSlice()).
/// - projection: for a drawing, it shows the projection; for bodies, its only slice is the projection.
/// - matrix: it shows the matrix.
///
/// The slice set must contain the surfaces (SliceSet::surfaces) for formats with Format::readsSurfaces, and for the
/// solid bodies of a field, unless ExportRequest::exact is true or the contents are ExportContentsKind::highlight, an
/// element of the field's box.
///
/// Bodies are closed and 2-manifold: every edge belongs to exactly two triangles, which traverse it in opposite
/// directions. Their normals point outward. They are in millimeters, unless the format requires meters.
///
/// Returns an ExportRefusal if a limit is exceeded, if there is nothing to export, if the format cannot contain what is
/// requested, or if a stop is requested. Throws std::runtime_error if a library that writes the file fails, if the font
/// of a label cannot be read, if the plate of a label cannot be made, or if the file of a field can no longer be read.
std::variant<ExportedFile, ExportRefusal> exportScene(const scene::Scene& scene, const slicing::Object& object,
                                                      const geometry::Rotation& orientation,
                                                      const ExportRequest& request, const ExportLimits& limits,
                                                      std::stop_token stop = {});

}  // namespace oval4d::exports
