#pragma once
// Conversion of settings and elements to text and back, for the page's command line and the queries of addresses.

#include <span>
#include <string>
#include <string_view>

#include "errors/error.hpp"
#include "session/command.hpp"
#include "session/query_text.hpp"

namespace oval4d::session {

/// The name of the setting ChangeSettings::object (the object to show).
inline constexpr std::string_view kPolytope = "polytope";

/// Parses the value of one setting and writes it to `set`. Examples of a name and a value: "slices" and "31", "alpha"
/// and "pi/12", "faces" and "off". The view `strip` is also read as "row". Errors: `unknown_command` for an unknown
/// name; `bad_expression` or `out_of_range` for an invalid value.
Result<std::monostate> parseSetting(std::string_view name, std::string_view written, ChangeSettings& set);

/// Returns the names and values of the settings in `set`, in the form that parseSetting() reads.
QueryParameters settingTexts(const ChangeSettings& set);

/// Returns the error `unknown_command` for a name that is not a setting. The message suggests a similar name, if there
/// is one: a setting, or one of `others`, names that are also allowed in this place.
Error unknownSettingError(std::string_view name, std::span<const std::string_view> others = {});

/// Returns all names that parseSetting() accepts, separated by commas.
std::string settingNames();

/// Returns the numbers as text, separated by commas, without loss of precision.
std::string numberListText(std::span<const double> numbers);

/// Parses the kind of an element: "cell", "face", "edge" or "vertex". Error: `bad_expression`.
Result<slicing::ElementKind> parseElementKind(std::string_view written);

/// Parses the index of an element. Error: `bad_expression`.
Result<std::size_t> parseElementIndex(std::string_view written);

}  // namespace oval4d::session
