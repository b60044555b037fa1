#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace oval4d::bench {

struct LibpngFile {
    double seconds;
    std::size_t bytes;
};

/// Reads a PNG file of RGB pixels and writes them again by libpng at level 1 with its default filters; times the
/// writing. Throws std::runtime_error for what is not such a file.
LibpngFile encodeByLibpng(std::span<const std::uint8_t> png);

}  // namespace oval4d::bench
