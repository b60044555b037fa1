#pragma once
// Exports one slice, or all slices of the oval, to a file for other programs.

#include <stop_token>
#include <string>
#include <variant>

#include "export/budget.hpp"
#include "export/export_request.hpp"
#include "scene/scene.hpp"
#include "slicing/object.hpp"

namespace oval4d::exports {

/// Returns the bytes of a file with the slices of `scene`, which must have been cut from `object` and laid out for the
/// oval view. For Extent::focus, the scene must contain only the focus slice. Bodies are in millimeters (in GLB
/// and X3D in meters, as these formats require), closed and 2-manifold: every edge belongs to exactly two triangles
/// that traverse it in opposite directions, and normals point outward. Returns an error if a limit is exceeded, if
/// there is nothing to export, or if a stop is requested. Throws std::runtime_error if lib3mf or tinygltf fails, or if
/// the font of a label cannot be read.
std::variant<std::string, ExportError> exportScene(const scene::Scene& scene, const slicing::Object& object,
                                                   const ExportRequest& request, const Limits& limits,
                                                   std::stop_token stop = {});

}  // namespace oval4d::exports
