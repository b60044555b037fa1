#pragma once
// The step before deflate: rows in a PNG file's order, without alpha, as differences.

#include <cstdint>
#include <vector>

#include "render/image.hpp"

namespace oval4d::render {

/// Turns the image upside down, drops alpha and takes from each row the one above it (PNG's filter "up", for the first
/// row too), in one pass. `out` gets height rows of 1 + 3 · width bytes; its memory is reused.
void filterUp(const Image& image, std::vector<std::uint8_t>& out);

}  // namespace oval4d::render
