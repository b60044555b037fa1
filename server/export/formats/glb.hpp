#pragma once

#include <string>

#include "export/formats/format.hpp"

namespace oval4d::exports {

/// Returns a binary glTF 2.0 file in meters, with a node for each body and with vertex colors. The normals of the
/// surfaces of fields vary smoothly, except across sharp edges (see smoothNormals()). Throws std::runtime_error if
/// tinygltf fails.
std::string glb(const MeshesToWrite& meshes);

}  // namespace oval4d::exports
