#include "render/overlay/font.hpp"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <algorithm>
#include <stdexcept>

namespace oval4d::render {

namespace {

constexpr int kWidth = 1024;  // the width of the texture in texels
constexpr int kStartHeight = 256;
constexpr int kMaxKeptHeight = 1024;  // if the texture is higher, clearIfLarge() removes all glyphs
constexpr int kMaxHeight = 8192;
constexpr int kMaxSize = 512;

}  // namespace

struct Font::Face {
    FT_Library library = nullptr;
    FT_Face face = nullptr;
    int size = 0;

    ~Face() {
        if (face != nullptr) FT_Done_Face(face);
        if (library != nullptr) FT_Done_FreeType(library);
    }
};

Font::Font(const std::string& file) : face_(std::make_unique<Face>()) {
    if (FT_Init_FreeType(&face_->library) != 0) throw std::runtime_error("FreeType cannot be initialized");
    if (FT_New_Face(face_->library, file.c_str(), 0, &face_->face) != 0)
        throw std::runtime_error("cannot read a font from " + file +
                                 " (install the Debian package fonts-dejavu-core, or set OVAL4D_FONT to a font file)");
    glGenTextures(1, &texture_);
    glBindTexture(GL_TEXTURE_2D, texture_);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    clear();
}

Font::~Font() { glDeleteTextures(1, &texture_); }

void Font::clear() {
    glyphs_.clear();
    height_ = kStartHeight;
    texels_.assign(static_cast<std::size_t>(kWidth) * kStartHeight, 0);
    texels_[0] = 255;
    shelfX_ = 2;
    shelfY_ = 0;
    shelfHeight_ = 1;
    changed_ = true;
}

void Font::clearIfLarge() {
    if (height_ > kMaxKeptHeight) clear();
}

const Glyph& Font::glyph(int size, char32_t character) {
    size = std::clamp(size, 1, kMaxSize);
    const auto key = std::pair(size, character);
    const auto found = glyphs_.find(key);
    return found != glyphs_.end() ? found->second : glyphs_.emplace(key, renderGlyph(size, character)).first->second;
}

Glyph Font::renderGlyph(int size, char32_t character) {
    if (size != face_->size) {
        FT_Set_Pixel_Sizes(face_->face, 0, static_cast<FT_UInt>(size));
        face_->size = size;
    }
    if (FT_Load_Char(face_->face, character, FT_LOAD_RENDER | FT_LOAD_TARGET_LIGHT) != 0) return {};
    const FT_GlyphSlot slot = face_->face->glyph;
    const FT_Bitmap& picture = slot->bitmap;
    Glyph glyph;
    glyph.width = static_cast<int>(picture.width);
    glyph.height = static_cast<int>(picture.rows);
    glyph.left = slot->bitmap_left;
    glyph.top = slot->bitmap_top;
    glyph.advance = static_cast<int>((slot->advance.x + 32) >> 6);
    std::tie(glyph.x, glyph.y) = reserveInAtlas(glyph.width, glyph.height);
    if (glyph.y < 0) return Glyph{.advance = glyph.advance};
    for (int row = 0; row < glyph.height; ++row)
        std::copy_n(picture.buffer + row * picture.pitch, glyph.width,
                    texels_.begin() + (glyph.y + row) * kWidth + glyph.x);
    changed_ = true;
    return glyph;
}

/// Reserves a rectangle in the texture by shelf packing (row by row). Returns the upper left texel of the rectangle, or
/// y = −1 if the texture is full.
std::pair<int, int> Font::reserveInAtlas(int width, int height) {
    if (shelfX_ + width > kWidth) {
        shelfY_ += shelfHeight_ + 1;
        shelfX_ = shelfHeight_ = 0;
    }
    while (shelfY_ + height > height_) {
        if (height_ >= kMaxHeight) return {0, -1};
        height_ *= 2;
        texels_.resize(static_cast<std::size_t>(kWidth) * static_cast<std::size_t>(height_), 0);
    }
    const std::pair place(shelfX_, shelfY_);
    shelfX_ += width + 1;
    shelfHeight_ = std::max(shelfHeight_, height);
    return place;
}

int Font::width(int size, std::string_view text) {
    int width = 0;
    forEachGlyph(size, text, [&](const Glyph& g, int pen) { width = pen + g.advance; });
    return width;
}

/// Removes the first character from a UTF-8 text, and returns it. Does not check continuation bytes. If the text begins
/// with a truncated sequence, or with a continuation byte, removes and returns only the first byte.
char32_t Font::takeCharacter(std::string_view& text) {
    const auto lead = static_cast<unsigned char>(text[0]);
    const std::size_t length = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : lead >= 0xc0 ? 2 : 1;
    char32_t character = lead;
    if (length > 1 && length <= text.size()) {
        character = lead & (0x7fu >> length);
        for (std::size_t i = 1; i < length; ++i)
            character = character << 6 | (static_cast<unsigned char>(text[i]) & 0x3f);
        text.remove_prefix(length);
    } else {
        text.remove_prefix(1);
    }
    return character;
}

void Font::bindTexture() {
    glBindTexture(GL_TEXTURE_2D, texture_);
    if (!changed_) return;
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, kWidth, height_, 0, GL_RED, GL_UNSIGNED_BYTE, texels_.data());
    changed_ = false;
}

}  // namespace oval4d::render
