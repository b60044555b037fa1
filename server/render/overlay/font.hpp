#pragma once
// A font, and a texture that caches its rendered glyphs (a glyph atlas).

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "render/gl.hpp"

namespace oval4d::render {

/// A glyph in the atlas: the place of its bitmap in the texture, in texels, and its metrics, in pixels.
struct Glyph {
    int x = 0, y = 0, width = 0, height = 0;
    /// How far the left edge of the bitmap is to the right of the pen position, and how far the top edge is above the
    /// baseline.
    int left = 0, top = 0;
    int advance = 0;  ///< the distance to the pen position of the next glyph
};

/// A font and its glyph atlas, which grows on demand. The texture of the atlas has one channel: the coverage. Texel (0,
/// 0) has full coverage, and is for shapes that are not glyphs. Requires a current GL context throughout its lifetime.
class Font {
  public:
    /// Opens the font file `file`. Throws std::runtime_error if `file` is not a readable font.
    explicit Font(const std::string& file);
    ~Font();
    Font(const Font&) = delete;
    Font& operator=(const Font&) = delete;

    /// Returns the glyph of a character. Renders the glyph on first use. `size` is the height of the em square in
    /// pixels, clamped to 1 … 512. If the font lacks the character, returns the font's replacement glyph. If the
    /// texture is full, the bitmap of the glyph is empty. The reference is valid until clearIfLarge() removes the
    /// glyphs.
    const Glyph& glyph(int size, char32_t character);

    /// Returns the width of a line of UTF-8 text in pixels.
    int width(int size, std::string_view text);

    /// Returns the height of a digit above the baseline in pixels.
    int digitHeight(int size) { return glyph(size, U'0').top; }

    /// Removes all glyphs if the texture has become large, because many of its glyphs may have sizes that are no longer
    /// used. Must not be called while a picture uses glyphs.
    void clearIfLarge();

    /// Binds the texture to the active texture unit. Uploads the texture if there are new glyphs.
    void bindTexture();

    /// Calls `each(glyph, pen)` for every character of the UTF-8 text `text`. `pen` is the x position of the character,
    /// in pixels from the start of the line.
    template <class Each>
    void forEachGlyph(int size, std::string_view text, Each&& each) {
        int pen = 0;
        while (!text.empty()) {
            const Glyph& g = glyph(size, takeCharacter(text));
            each(g, pen);
            pen += g.advance;
        }
    }

  private:
    static char32_t takeCharacter(std::string_view& text);
    Glyph renderGlyph(int size, char32_t character);
    std::pair<int, int> reserveInAtlas(int width, int height);
    void clear();

    struct Face;
    std::unique_ptr<Face> face_;
    std::map<std::pair<int, char32_t>, Glyph> glyphs_;
    std::vector<std::uint8_t> texels_;
    // The height of the texture, and data about the last row of glyphs in it: the x of the next glyph, the top of the
    // row, and the height of the row.
    int height_ = 0, shelfX_ = 0, shelfY_ = 0, shelfHeight_ = 0;
    bool changed_ = true;  // whether texels_ has glyphs that must be uploaded to the texture
    GLuint texture_ = 0;
};

}  // namespace oval4d::render
