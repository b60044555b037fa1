#pragma once
// Exports a slice, or the whole oval, to a file for other programs.

#include <stop_token>
#include <string>
#include <variant>

#include "export/budget.hpp"
#include "export/export_request.hpp"
#include "scene/scene.hpp"
#include "slicing/object.hpp"

namespace oval4d::exports {

/// Exports `scene`, whose slices were cut from `object` and are placed as in the oval view, and returns the bytes of
/// the file. For SliceSelection::focus, the scene must contain only the focus slice. Bodies are in millimeters (in GLB,
/// in meters, as glTF requires), closed and 2-manifold: every edge belongs to exactly two triangles that traverse it in
/// opposite directions, and normals point outward. Returns a refusal if a limit is exceeded, if there is nothing to
/// export, or if a stop is requested.
std::variant<std::string, Refusal> fileOf(const scene::Scene& scene, const slicing::Object& object,
                                          const ExportRequest& request, const Limits& limits,
                                          std::stop_token stop = {});

}  // namespace oval4d::exports
