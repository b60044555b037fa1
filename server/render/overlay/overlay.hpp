#pragma once
// Boxes and text drawn over the picture, in pixel coordinates.

#include <cstdint>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "render/overlay/text.hpp"
#include "render/program.hpp"
#include "scene/scene.hpp"

namespace oval4d::render {

/// A corner of a box or of a glyph. The coverage of a pixel is that of a rounded box times that of the texture.
struct OverlayVertex {
    glm::vec2 at{0};          ///< −1 … 1
    glm::vec2 fromCenter{0};  ///< in pixels
    glm::vec3 box{0};         ///< half width, half height and corner radius
    glm::vec2 texel{0.5f};
    std::uint32_t color = 0;
};

struct Box {
    float left, bottom, right, top;
};

/// A list of boxes and lines of text; later ones cover earlier ones. Pixel coordinates are from the lower left corner.
/// Requires a current GL context throughout its lifetime.
class Overlay {
  public:
    explicit Overlay(const std::string& font);

    /// Starts an empty list for a picture of this size.
    void begin(scene::Viewport viewport);

    /// Adds a box. Its edges are antialiased unless they lie on pixel boundaries.
    void box(const Box& box, scene::Color color, float opacity = 1, float cornerRadius = 0);

    /// Adds a line of text, centered at x and with its baseline at y. It is moved to whole pixels, where it is
    /// sharpest.
    void text(float x, float y, int size, std::string_view text, scene::Color color, float opacity = 1);

    Font& font() { return font_; }

    void draw();

  private:
    void quad(const Box& place, const OverlayVertex& vertex, const Box& fromCenter, const Box& texels);

    Program program_;
    Font font_;
    glm::vec2 toClip_{0};
    std::vector<OverlayVertex> vertices_;
    std::vector<std::uint32_t> indices_;
};

}  // namespace oval4d::render
