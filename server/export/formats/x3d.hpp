#pragma once

#include <string>

#include "export/formats/format.hpp"

namespace oval4d::exports {

/// Returns an X3D 3.3 file in the XML encoding (ISO/IEC 19775-1 and 19776-1), in meters, with a Shape for each body and
/// a color for each triangle or, for fields, for each point. Throws ExportRefused if the time limit is exceeded or a
/// stop is requested.
std::string x3d(const MeshesToWrite& meshes);

}  // namespace oval4d::exports
