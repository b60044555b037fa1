#pragma once
// Parses settings and elements, given as text on the ':' line and in the queries of URLs.

#include <string_view>

#include "errors/error.hpp"
#include "session/command.hpp"

namespace oval4d::session {

/// Parses the value of one setting and writes it to `set`. Examples of a name and a value: "slices" and "31", "alpha"
/// and "pi/12", "faces" and "off". Errors: `unknown_command` for an unknown name; `bad_expression` or `out_of_range`
/// for an invalid value.
Result<std::monostate> parseSetting(std::string_view name, std::string_view value, Set& set);

/// Parses the kind of an element, such as "cell". Error: `bad_expression`.
Result<slicing::ElementKind> parseElementKind(std::string_view text);

/// Parses the index of an element. Error: `bad_expression`.
Result<std::size_t> parseElementIndex(std::string_view text);

/// Returns all names that parseSetting() accepts, separated by commas.
std::string settingNames();

}  // namespace oval4d::session
