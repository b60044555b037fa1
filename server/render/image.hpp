#pragma once
// Pixels, and PNG files from them.

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "scene/scene.hpp"

namespace oval4d::render {

/// RGBA, 8 bits a channel, rows from the bottom up as OpenGL leaves them, no padding.
struct Image {
    int width = 0, height = 0;
    std::vector<std::uint8_t> pixels;
};

inline std::size_t bytesOf(scene::Viewport viewport) {
    return 4 * static_cast<std::size_t>(viewport.width) * static_cast<std::size_t>(viewport.height);
}

/// The same pixels, wherever they lie.
struct ImageView {
    int width = 0, height = 0;
    std::span<const std::uint8_t> pixels;
};

/// Writes `image` as an 8-bit RGB PNG file (alpha is dropped), the text `state` (UTF-8) in an uncompressed iTXt
/// chunk keyed "oval4d", first after IHDR. `out` is overwritten and its memory reused. One encoder serves one thread.
class PngEncoder {
  public:
    void encode(const ImageView& image, std::string_view state, std::vector<std::uint8_t>& out);
    void encode(const Image& image, std::string_view state, std::vector<std::uint8_t>& out) {
        encode(ImageView{image.width, image.height, image.pixels}, state, out);
    }

  private:
    /// Some rows on their way into the file.
    struct Band {
        std::vector<std::uint8_t> filtered, levelBuffer, chunk;
        std::uint32_t checksum = 0;  // Adler-32 of `filtered`
    };
    static void encode(const ImageView& image, int from, int to, Band& band);

    std::array<Band, 2> bands_;
};

}  // namespace oval4d::render
