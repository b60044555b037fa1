#pragma once
// Finds the state in PNG files.

#include <optional>
#include <string_view>

namespace oval4d::image {

/// Returns whether the bytes start as a PNG file does.
bool isPng(std::string_view file);

/// Returns the text that PngEncoder::encode() stored in the file: that of the first uncompressed iTXt chunk with the
/// keyword "oval4d" (PNG specification, section 11.3.3.4). Returns nothing if there is none, if the file ends before
/// it, or if the bytes are not a PNG file. Ignores the checksums.
std::optional<std::string_view> stateIn(std::string_view file);

}  // namespace oval4d::image
