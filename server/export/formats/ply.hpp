#pragma once

#include <string>

#include "export/formats/format.hpp"

namespace oval4d::exports {

/// Returns a binary little-endian PLY file in millimeters, with all bodies in one mesh and a color for each triangle.
std::string ply(const BodiesToWrite& bodies);

}  // namespace oval4d::exports
