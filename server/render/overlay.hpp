#pragma once
// Flat shapes and text over the picture, in pixels.

#include <cstdint>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "render/program.hpp"
#include "render/text.hpp"
#include "scene/scene.hpp"

namespace oval4d::render {

/// A corner of a box or of a glyph. Coverage is that of a box with round corners, times the texture's.
struct OverlayVertex {
    glm::vec2 at{0};          ///< −1 … 1
    glm::vec2 fromCentre{0};  ///< in pixels
    glm::vec3 box{0};         ///< half its width and height, and its corners' radius
    glm::vec2 texel{0.5f};
    std::uint32_t colour = 0;
};

struct Box {
    float left, bottom, right, top;
};

/// A list of boxes and lines of text; later ones lie over earlier ones. Pixels count from the lower left corner.
/// Needs a current context for all of its life.
class Overlay {
  public:
    explicit Overlay(const std::string& font);

    void begin(scene::Viewport viewport);

    /// Its edges are antialiased where they do not lie on the pixels' own.
    void box(const Box& box, scene::Colour colour, float opacity = 1, float cornerRadius = 0);

    /// `text` is centred at x, its baseline at y; moved to whole pixels, where it is sharpest.
    void text(float x, float y, int size, std::string_view text, scene::Colour colour, float opacity = 1);

    Font& font() { return font_; }

    void draw();

  private:
    void quad(const Box& place, const OverlayVertex& vertex, const Box& fromCentre, const Box& texels);

    Program program_;
    Font font_;
    glm::vec2 toClip_{0};
    std::vector<OverlayVertex> vertices_;
    std::vector<std::uint32_t> indices_;
};

}  // namespace oval4d::render
