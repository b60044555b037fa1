#pragma once
// Converts text to the outlines of its letters.

#include <string>
#include <vector>

#include "export/mesh/tessellate.hpp"

namespace oval4d::exports {

/// The outlines of a block of text, centered at the origin. The unit is the height of a capital letter.
struct Lettering {
    std::vector<Contour> contours;  ///< the areas of the letters lie on the left of the contours (see outlineOf())
    glm::dvec2 size{0};             ///< width and height of the bounding box
};

/// Returns the outlines of lines of UTF-8 text, each line centered below the previous one. The result has no contours
/// if no character of the text has an outline. Throws std::runtime_error if the font cannot be read.
Lettering letteringOf(const std::vector<std::string>& lines);

}  // namespace oval4d::exports
