#pragma once

#include <string>

#include "export/formats/format.hpp"

namespace oval4d::exports {

/// Binary glTF 2.0, in meters, with a node for each body and vertex colors.
std::string glb(const Bodies& bodies);

}  // namespace oval4d::exports
