#pragma once
// PNG filtering, the step before deflate: replaces each byte by its difference from a prediction.

#include <cstdint>
#include <vector>

#include "image/image.hpp"

namespace oval4d::image {

/// Computes the filtered rows `from` to `to` − 1 of a PNG file, counted from the top of the image. Flips the image
/// vertically, drops alpha, and applies PNG's Paeth filter, which predicts a pixel from its left, upper and upper-left
/// neighbors. Row 0 has no upper neighbors and gets the Sub filter, which predicts a pixel from its left neighbor.
/// Overwrites `out` with 1 + 3 · width bytes for each row, the filter type first, and reuses its memory.
void makeFilteredRows(const image::ImageView& image, int from, int to, std::vector<std::uint8_t>& out);

}  // namespace oval4d::image
