#pragma once

#include <string>

#include "export/formats/format.hpp"

namespace oval4d::exports {

/// The rotated object in 4OFF, in its own units. Reading the file gives the same object.
std::string off(const Source& source);

}  // namespace oval4d::exports
