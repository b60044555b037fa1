#pragma once
// PNG filtering, the step before compression: replaces each byte by its difference from a predicted byte.

#include <cstdint>
#include <vector>

#include "image/image.hpp"

namespace oval4d::image {

/// Writes the filtered rows `from` … `to` − 1 of a PNG file to `out`; row 0 is the top of the image. Drops alpha. Row 0
/// has the filter Sub, which predicts each byte from the pixel to the left. All other rows have the filter Paeth, which
/// predicts it from the left, upper and upper-left pixels. Each row takes 1 + 3 · width bytes, beginning with the
/// filter type. Overwrites `out` and reuses its memory.
void makeFilteredRows(const image::ImageView& image, int from, int to, std::vector<std::uint8_t>& out);

}  // namespace oval4d::image
