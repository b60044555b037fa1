#pragma once
// The step before deflate: rows in a PNG file's order, without alpha, as differences from a prediction.

#include <cstdint>
#include <vector>

#include "render/image.hpp"

namespace oval4d::render {

/// Turns the image upside down, drops alpha and takes from each pixel what PNG's filter "Paeth" predicts from its
/// neighbours to the left, above and between them, in one pass (the first row has nothing above: filter "sub"). `out`
/// gets the file's rows from … to − 1, of 1 + 3 · width bytes each; its memory is reused.
void filterRows(const ImageView& image, int from, int to, std::vector<std::uint8_t>& out);

}  // namespace oval4d::render
