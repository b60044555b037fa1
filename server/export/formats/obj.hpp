#pragma once

#include <string>

#include "export/formats/format.hpp"

namespace oval4d::exports {

/// Wavefront OBJ, with an object for each body that contains a group for each cell.
std::string obj(const Bodies& bodies);

}  // namespace oval4d::exports
