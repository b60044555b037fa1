#pragma once
// Converts text to outlines.

#include <string>
#include <vector>

#include "export/mesh/tessellate.hpp"

namespace oval4d::exports {

/// A block of text, centered at the origin. The unit is the height of a capital letter.
struct Lettering {
    std::vector<Contour> contours;  ///< counterclockwise around the letters' area
    glm::dvec2 size{0};             ///< of the bounding box
};

/// Sets lines of UTF-8 text, each centered below the previous one. Throws std::runtime_error if the font cannot be
/// read.
Lettering letteringOf(const std::vector<std::string>& lines);

}  // namespace oval4d::exports
