#pragma once
// The fixed colors and sizes of pictures.

#include <array>

#include <glm/vec3.hpp>

#include "scene/color.hpp"

namespace oval4d::scene {

/// The colors and sizes that are the same in all pictures.
struct Style {
    Color background, text, focusText, ball, bar, zeroLine;
    std::array<Color, 4> axes;  ///< the colors of the axes x, y, z and w
    Color highlight;            ///< the color of the highlighted element
    double faceOpacity;         ///< 0 … 1
    glm::dvec3 light;           ///< unit vector toward the light, in camera axes
    /// The Blinn–Phong shading of balls and bars, for the normal n, the direction l to the light and the half vector h:
    /// color · (ambient + diffuse · max(n·l, 0)) + specular · max(n·h, 0)^shininess.
    double ambient, diffuse, specular, shininess;
    double textHeight;  ///< the font size of labels, as a fraction of the viewport's height
};
/// Returns the style of all pictures.
const Style& style();

}  // namespace oval4d::scene
