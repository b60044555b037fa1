#pragma once
// Converts text to the outlines of its letters, with FreeType.

#include <string>
#include <vector>

#include "export/mesh/tessellate.hpp"

namespace oval4d::exports {

/// The outlines of a block of text, centered at the origin. The unit is the height of a capital letter.
struct TextOutlines {
    std::vector<Contour> contours;  ///< outlines; the letters lie to the left of the contours (see outlineOf())
    glm::dvec2 size{0};             ///< width and height of the bounding box
};

/// Returns the outlines of lines of UTF-8 text. Each line is centered below the previous line. The result has no
/// contours if no character has an outline. Throws std::runtime_error if the font cannot be read.
TextOutlines textOutlinesOf(const std::vector<std::string>& lines);

}  // namespace oval4d::exports
