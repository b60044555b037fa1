#pragma once
// Settings and elements as text, on the page's command line and in the queries of addresses.

#include <span>
#include <string>
#include <string_view>

#include "errors/error.hpp"
#include "session/command.hpp"
#include "session/query_text.hpp"

namespace oval4d::session {

/// The name of the setting Set::object.
inline constexpr std::string_view kPolytope = "polytope";

/// Parses the value of one setting and writes it to `set`. Examples of a name and a value: "slices" and "31", "alpha"
/// and "pi/12", "faces" and "off". Errors: `unknown_command` for an unknown name; `bad_expression` or `out_of_range`
/// for an invalid value.
Result<std::monostate> parseSetting(std::string_view name, std::string_view written, Set& set);

/// Returns the names and values of the settings that `set` contains, in the form that parseSetting() reads.
QueryParameters settingTexts(const Set& set);

/// Returns the error `unknown_command` for a name that is no setting. Its message contains a similar name, if there is
/// one. `others` are names that are accepted besides those of settings.
Error unknownSetting(std::string_view name, std::span<const std::string_view> others = {});

/// Returns all names that parseSetting() accepts, separated by commas.
std::string settingNames();

/// Returns the numbers, separated by commas.
std::string numberList(std::span<const double> numbers);

/// Parses the kind of an element, such as "cell". Error: `bad_expression`.
Result<slicing::ElementKind> parseElementKind(std::string_view written);

/// Parses the index of an element. Error: `bad_expression`.
Result<std::size_t> parseElementIndex(std::string_view written);

}  // namespace oval4d::session
