#pragma once

#include <string>

#include "export/formats/format.hpp"

namespace oval4d::exports {

/// Returns a Wavefront OBJ file in millimeters. Each body is an object; in it, the triangles of each cell form a group.
std::string obj(const MeshesToWrite& meshes);

}  // namespace oval4d::exports
