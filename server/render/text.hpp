#pragma once
// Glyphs of one font, drawn once each into a texture.

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "render/gl.hpp"

namespace oval4d::render {

/// A glyph's picture in the texture, in texels, and its place in a line of text, in pixels.
struct Glyph {
    int x = 0, y = 0, width = 0, height = 0;
    int left = 0, top = 0;  ///< from the pen to the picture's left edge, and up to its upper edge
    int advance = 0;
};

/// Grows as glyphs are asked for; a glyph once drawn costs a lookup. Its texture has one channel (coverage) and one
/// solid texel at (0, 0) for shapes without a texture. Needs a current context for all of its life.
class Font {
  public:
    /// Throws std::runtime_error if `file` is not a font.
    explicit Font(const std::string& file);
    ~Font();
    Font(const Font&) = delete;
    Font& operator=(const Font&) = delete;

    /// `size` is the height of the em square in pixels. A character that the font lacks gives its empty box.
    const Glyph& glyph(int size, char32_t character);

    /// Of a line of UTF-8, in pixels.
    int width(int size, std::string_view text);

    /// From the baseline up to the top of a digit.
    int digitHeight(int size) { return glyph(size, U'0').top; }

    /// Forgets old glyphs where sizes have come and gone; call between pictures.
    void tidy();

    /// Binds the texture, with all glyphs asked for so far in it.
    void bind();

    /// Calls `each(glyph, pen)` for every character of `text`.
    template <class Each>
    void layOut(int size, std::string_view text, Each&& each) {
        int pen = 0;
        while (!text.empty()) {
            const Glyph& g = glyph(size, takeCharacter(text));
            each(g, pen);
            pen += g.advance;
        }
    }

  private:
    static char32_t takeCharacter(std::string_view& text);
    Glyph draw(int size, char32_t character);
    std::pair<int, int> reserve(int width, int height);
    void clear();

    struct Face;
    std::unique_ptr<Face> face_;
    std::map<std::pair<int, char32_t>, Glyph> glyphs_;
    std::vector<std::uint8_t> texels_;
    int height_ = 0, shelfX_ = 0, shelfY_ = 0, shelfHeight_ = 0;
    bool changed_ = true;
    GLuint texture_ = 0;
};

}  // namespace oval4d::render
