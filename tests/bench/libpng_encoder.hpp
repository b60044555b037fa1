#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace oval4d::bench {

struct LibpngFile {
    double seconds;
    std::size_t bytes;
};

/// Reads a PNG file of RGB pixels, encodes the pixels with libpng at level 1 and default filters, and measures the time
/// of the encoding. Throws std::runtime_error if the file is not such a file.
LibpngFile encodeByLibpng(std::span<const std::uint8_t> png);

}  // namespace oval4d::bench
