#pragma once

#include <string>

#include "export/drawing/drawing.hpp"

namespace oval4d::exports {

/// Returns the drawing as a PDF 1.4 document of one page, which has the size of the drawing. Throws std::runtime_error
/// if there is not enough memory.
std::string pdf(const Drawing& drawing);

}  // namespace oval4d::exports
