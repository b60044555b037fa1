#pragma once

#include <string>

#include "export/formats/format.hpp"

namespace oval4d::exports {

/// Returns a 3MF file in millimeters, with an object for each body. Throws std::runtime_error if lib3mf fails, and
/// ExportRefused if the time limit is exceeded or a stop is requested.
std::string threeMf(const MeshesToWrite& meshes);

}  // namespace oval4d::exports
