#pragma once

#include <string>

#include "export/drawing/drawing.hpp"

namespace oval4d::exports {

/// Returns the drawing as an SVG 1.1 image.
std::string svg(const Drawing& drawing);

}  // namespace oval4d::exports
