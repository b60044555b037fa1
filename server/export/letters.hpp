#pragma once
// Text as outlines.

#include <string>
#include <vector>

#include "export/tessellate.hpp"

namespace oval4d::exports {

/// A block of text, centred in the origin; a capital letter is 1 high.
struct Lettering {
    std::vector<Contour> contours;  ///< counter-clockwise around what they hold
    glm::dvec2 size{0};
};

/// Lines of UTF-8, centred below each other. Throws std::runtime_error if the font cannot be read.
Lettering letteringOf(const std::vector<std::string>& lines);

}  // namespace oval4d::exports
