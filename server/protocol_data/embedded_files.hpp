#pragma once
// The JSON files of protocol/ (such as keymap.json) and the schemas in protocol/schema/, compiled into the program.

#include <span>
#include <string_view>

namespace oval4d::protocol_data {

/// Returns the paths of all files, relative to protocol/.
std::span<const std::string_view> embeddedPaths();

/// Returns the text of a file by its path relative to protocol/, such as "keymap.json"; empty if there is no such file.
std::string_view embeddedFile(std::string_view path);

}  // namespace oval4d::protocol_data
