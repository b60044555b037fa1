#pragma once

#include <string>

#include "export/formats/format.hpp"

namespace oval4d::exports {

/// An SVG drawing of the parallel coordinates of the rotated vertices.
std::string svg(const Source& source);

}  // namespace oval4d::exports
