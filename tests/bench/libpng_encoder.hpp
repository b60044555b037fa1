#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace oval4d::bench {

/// The result of encoding a picture with libpng.
struct LibpngFile {
    double seconds;     ///< how long the encoding took
    std::size_t bytes;  ///< the size of the encoded file
};

/// Decodes a PNG file to RGB pixels, then encodes the pixels with libpng at compression level 1 with the default
/// filters. Measures only the encoding. Throws std::runtime_error if `png` is not a valid PNG file.
LibpngFile encodeByLibpng(std::span<const std::uint8_t> png);

}  // namespace oval4d::bench
