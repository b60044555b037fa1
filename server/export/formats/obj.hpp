#pragma once

#include <string>

#include "export/formats/format.hpp"

namespace oval4d::exports {

/// Returns a Wavefront OBJ file in millimeters, with an object for each body and, in it, a group for each cell.
std::string obj(const BodiesToWrite& bodies);

}  // namespace oval4d::exports
