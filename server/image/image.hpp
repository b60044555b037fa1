#pragma once
// Images as arrays of pixels in memory.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace oval4d::image {

/// An RGBA image with 8 bits per channel: `pixels` has 4 · width · height bytes. The bottom row comes first, as in
/// OpenGL. Rows have no padding. The colors are multiplied by alpha. Most images are opaque.
struct Image {
    int width = 0, height = 0;
    std::vector<std::uint8_t> pixels;
};

/// Returns the size, in bytes, of the pixels of an image with this width and height.
constexpr std::size_t byteCount(int width, int height) {
    return 4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

/// A view of an image with the layout of Image. It does not own the pixels.
struct ImageView {
    int width = 0, height = 0;
    std::span<const std::uint8_t> pixels;
    bool hasAlpha = false;  ///< whether files of this image have an alpha channel; if false, alpha is ignored
};

}  // namespace oval4d::image
