#pragma once
// The data files of protocol/ (keymap.json, errors.json, schema/*.json), compiled into the program.

#include <string_view>

namespace oval4d::protocol {

/// The text of the file at this path below protocol/, for example "keymap.json". Empty if there is none.
std::string_view embedded(std::string_view path);

}  // namespace oval4d::protocol
