#pragma once
// The settings by name, as the ':' line and a query give them.

#include <string_view>

#include "protocol/cpp/error.hpp"
#include "protocol/cpp/request.hpp"

namespace oval4d::session {

/// Puts one setting into `set`: "slices" and "31", "alpha" and "pi/12", "faces" and "off". An unknown name is
/// `unknown_command`, a value that cannot be read `bad_expression` or `out_of_range`.
protocol::Result<std::monostate> putSetting(std::string_view name, std::string_view value, protocol::Set& set);

/// All names that putSetting knows.
std::string settingNames();

}  // namespace oval4d::session
