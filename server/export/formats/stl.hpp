#pragma once

#include <string>

#include "export/formats/format.hpp"

namespace oval4d::exports {

/// Returns a binary STL file in millimeters, with all bodies in one mesh.
std::string stl(const MeshesToWrite& meshes);

}  // namespace oval4d::exports
