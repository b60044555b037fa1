#pragma once
// The fixed colors and sizes of pictures, which depend only on the background.

#include <array>

#include <glm/vec3.hpp>

#include "scene/background.hpp"
#include "scene/color.hpp"

namespace oval4d::scene {

/// The fixed colors and sizes of pictures. All pictures with the same background have the same style. Only the colors,
/// `backgroundOpacity` and `faceOpacity` depend on the background.
struct PictureStyle {
    Color background, text, focusText, ball, bar, zeroLine;
    double backgroundOpacity;   ///< 1, or 0 if the background is transparent
    std::array<Color, 4> axes;  ///< the colors of the axes x, y, z and w
    Color highlight;            ///< the color of the highlighted element
    double faceOpacity;         ///< the opacity of the faces of slices, 0 … 1
    glm::dvec3 light;           ///< a unit vector toward the light, in view coordinates: x right, y up, z to the viewer
    /// The Blinn–Phong shading of balls, bars and surfaces. For the normal n, the direction l to the light and the half
    /// vector h, the shaded color is color · (ambient + diffuse · max(n·l, 0)) + specular · max(n·h, 0)^shininess.
    double ambient, diffuse, specular, shininess;
    double textHeight;  ///< the font size of labels, as a fraction of the viewport's height
};

/// Returns the style of pictures with the background `background`. The style for `automatic` is the style for `dark`.
///
/// Texts have a contrast (WCAG 2.2) to the background of at least 4.5; balls, bars and lines have a contrast of at
/// least 3. Only the zero lines of the parallel coordinates on a dark background are fainter.
const PictureStyle& style(Background background = Background::automatic);

}  // namespace oval4d::scene
