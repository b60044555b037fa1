#pragma once
// Pixels, and PNG files from them.

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace oval4d::render {

/// RGBA, 8 bits a channel, rows from the bottom up as OpenGL leaves them, no padding.
struct Image {
    int width = 0, height = 0;
    std::vector<std::uint8_t> pixels;
};

/// Writes `image` as an 8-bit RGB PNG file (alpha is dropped), the text `state` (UTF-8) in an uncompressed iTXt
/// chunk keyed "oval4d", first after IHDR. `out` is overwritten and its memory reused. One encoder serves one thread.
class PngEncoder {
  public:
    void encode(const Image& image, std::string_view state, std::vector<std::uint8_t>& out);

  private:
    std::vector<std::uint8_t> filtered_, levelBuffer_;
};

}  // namespace oval4d::render
