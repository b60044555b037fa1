#pragma once
// PNG filtering, the step before compression: it replaces each byte by its difference from a predicted byte.

#include <cstdint>
#include <vector>

#include "image/image.hpp"

namespace oval4d::image {

/// Writes the filtered rows `from` … `to` − 1 of a PNG file to `out`; row 0 is the top of the image. Row 0 has the
/// filter Sub, which predicts each byte from the pixel to the left. All other rows have the filter Paeth, which
/// predicts each byte from the left, upper and upper-left pixels. Each row begins with one byte, the filter type. An
/// RGB row takes 1 + 3 · width bytes. If ImageView::hasAlpha is true, a row takes 1 + 4 · width bytes, and its colors
/// are divided by alpha, because colors in PNG files are not multiplied by alpha. Overwrites `out` and reuses its
/// memory.
void makeFilteredRows(const image::ImageView& image, int from, int to, std::vector<std::uint8_t>& out);

}  // namespace oval4d::image
