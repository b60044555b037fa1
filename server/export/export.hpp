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

/// An exported file, with warnings.
struct ExportedFile {
    std::string bytes;
    /// Texts for the user about what the file lacks, such as slices without a body, or labels without room. A warning
    /// contains no semicolon and no full stop at its end. Its only character outside of ASCII is the minus sign U+2212.
    std::vector<std::string> warnings;
};

/// Returns a file with the slices of `scene`, or with a drawing of `scene`. The slices must have been cut from `object`
/// rotated by `orientation`. Some values of ExportRequest::contents require more of `scene`:
/// - focus: the scene contains only the focus slice.
/// - oval: the view of the scene shows all slices (see scene::showsAllSlices()).
/// - highlight: Look::highlight of the scene is the element to export, and the only slice is this element (see
///   slicing::writeElementAsSlice()).
/// - projection: for a drawing, the scene shows the projection; for bodies, the only slice is the projection.
/// - matrix: the scene shows the matrix.
///
/// The slices must have surfaces (SliceSet::surfaces) for formats with Format::readsSurfaces, and for the solid bodies
/// of a field. This is not required if ExportRequest::exact is true, or for ExportContentsKind::highlight, because the
/// element is then a part of the field's box.
///
/// Bodies are closed and 2-manifold: every edge belongs to exactly two triangles, which traverse it in opposite
/// directions. Their normals point outward. Bodies are in millimeters, unless the format requires meters.
///
/// Returns an ExportRefusal if a limit is exceeded, if there is nothing to export, if the format cannot contain the
/// requested contents, or if a stop was requested. Throws std::runtime_error if a library that writes the file fails,
/// if the font of a label cannot be read, if the plate of a label cannot be made, or if the file from which a field
/// reads its samples has become unreadable.
std::variant<ExportedFile, ExportRefusal> exportScene(const scene::Scene& scene, const slicing::Object& object,
                                                      const geometry::Rotation& orientation,
                                                      const ExportRequest& request, const ExportLimits& limits,
                                                      std::stop_token stop = {});

}  // namespace oval4d::exports
