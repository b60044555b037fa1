#pragma once
// Draws boxes, lines, polygons and text over the picture, in pixel coordinates.

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "render/overlay/font.hpp"
#include "render/shader_program.hpp"
#include "scene/scene.hpp"

namespace oval4d::render {

/// A corner of a box, line, polygon or glyph. The opacity of a pixel is a product of three factors: the opacity of the
/// color, the fraction of the pixel that a box with rounded corners covers, and the coverage in the glyph texture.
struct OverlayVertex {
    glm::vec2 at{0};          ///< the clip coordinates of the corner, −1 … 1
    glm::vec2 fromCenter{0};  ///< the position of the corner relative to the center of the box, in pixels
    glm::vec3 box{0};         ///< half the width, half the height and the corner radius of the box, in pixels
    glm::vec2 texel{0.5f};    ///< the position in the glyph texture, in texels; the default position has full coverage
    std::uint32_t color = 0;  ///< the color, as returned by rgba()
};

/// A rectangle in pixel coordinates.
struct PixelRect {
    float left, bottom, right, top;
};

/// Collects boxes, lines, polygons and text, and draws them in the order in which they were added. Pixel coordinates
/// are counted from the lower left corner of the picture. Requires a current GL context throughout its lifetime.
class Overlay {
  public:
    /// `font` is the path of a font file. Throws std::runtime_error if the font cannot be read, or if a shader does not
    /// compile.
    explicit Overlay(const std::string& font);

    /// Removes everything that was added, and starts a picture with the size of `viewport`.
    void begin(scene::Viewport viewport);

    /// Adds a box with rounded corners of the radius `cornerRadius`, in pixels. The edges are antialiased unless they
    /// lie on pixel boundaries.
    void box(const PixelRect& box, scene::Color color, float opacity = 1, float cornerRadius = 0);

    /// Adds a straight line with round ends, `width` pixels wide.
    void line(glm::vec2 from, glm::vec2 to, float width, scene::Color color, float opacity = 1);

    /// Adds a convex polygon. The edges of the polygon are not antialiased; the caller can hide the jagged edges by
    /// lines over them.
    void polygon(std::span<const glm::vec2> corners, scene::Color color, float opacity = 1);

    /// Adds a line of UTF-8 text. The text is centered at x, with its baseline at y. `size` is the height of the em
    /// square in pixels. The text is moved to whole pixels, where it is sharpest.
    void text(float x, float y, int size, std::string_view text, scene::Color color, float opacity = 1);

    Font& font() { return font_; }

    /// Draws everything that was added since begin().
    void draw();

  private:
    void quad(const PixelRect& place, const OverlayVertex& vertex, const PixelRect& fromCenter,
              const PixelRect& texels);

    ShaderProgram program_;
    Font font_;
    glm::vec2 toClip_{0};
    std::vector<OverlayVertex> vertices_;
    std::vector<std::uint32_t> indices_;
};

}  // namespace oval4d::render
