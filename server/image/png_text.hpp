#pragma once
// Finds the text that PngEncoder stores in PNG files: the state of a picture.

#include <optional>
#include <string_view>

namespace oval4d::image {

/// Returns whether the bytes of `file` start with the signature of PNG files.
bool isPng(std::string_view file);

/// Returns the text that PngEncoder::encode() stored in `file`, as a part of `file`. This is the text of the first
/// uncompressed iTXt chunk with the keyword "oval4d" (PNG specification, section 11.3.3.4). Returns an empty optional
/// if there is no such chunk, if the chunk is incomplete, or if the bytes are not a PNG file. Ignores the checksums.
std::optional<std::string_view> stateTextIn(std::string_view file);

}  // namespace oval4d::image
