#pragma once

#include <string>

#include "export/formats/format.hpp"

namespace oval4d::exports {

/// X3D 3.3 in its XML encoding (ISO/IEC 19775-1 and 19776-1), in meters: a Shape for each body, with the colors of the
/// cells per triangle.
std::string x3d(const Bodies& bodies);

}  // namespace oval4d::exports
