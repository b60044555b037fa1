#pragma once
// Images as arrays of pixels.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/camera.hpp"

namespace oval4d::image {

/// An image in RGBA with 8 bits per channel. Rows run from the bottom up, as in OpenGL, without padding.
struct Image {
    int width = 0, height = 0;
    std::vector<std::uint8_t> pixels;
};

/// The bytes of the pixels of an image of this size.
inline std::size_t bytesOf(scene::Viewport viewport) {
    return 4 * static_cast<std::size_t>(viewport.width) * static_cast<std::size_t>(viewport.height);
}

/// An image in memory that it does not own.
struct ImageView {
    int width = 0, height = 0;
    std::span<const std::uint8_t> pixels;
};

}  // namespace oval4d::image
