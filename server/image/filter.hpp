#pragma once
// PNG filtering, the step before deflate: replaces each byte by its difference from a prediction.

#include <cstdint>
#include <vector>

#include "image/image.hpp"

namespace oval4d::image {

/// Flips the image vertically, drops alpha and applies PNG's Paeth filter, which predicts a pixel from its left, upper
/// and upper-left neighbors, all in one pass. The first row has no upper neighbors and gets the Sub filter. Writes rows
/// `from` to `to` − 1 of the PNG file to `out`, 1 + 3 · width bytes each, and reuses the memory of `out`.
void filterRows(const image::ImageView& image, int from, int to, std::vector<std::uint8_t>& out);

}  // namespace oval4d::image
