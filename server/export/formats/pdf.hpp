#pragma once

#include <string>

#include "export/drawing/drawing.hpp"

namespace oval4d::exports {

/// Returns the drawing as a PDF 1.4 document of one page, which has the size of the drawing on paper. Width and height
/// must be from 3 to 14,400 points (1/72 inch). Throws std::runtime_error if they are not, or if there is not enough
/// memory.
std::string pdf(const Drawing& drawing);

}  // namespace oval4d::exports
