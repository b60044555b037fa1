#pragma once
// Text for messages: suggestions ("did you mean …?"), lists, quotes and numbers.

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace oval4d::text {

/// Returns the candidate with the smallest edit distance (Levenshtein) from `text`. If several candidates have this
/// distance, returns the first of them that is as long as `text`, or if there is none, the first of them. Returns an
/// empty string if the distance is more than about half of the candidate's length.
std::string_view closestMatch(std::string_view text, std::span<const std::string_view> candidates);

/// Returns " (did you mean 'x'?)" with the candidate x that closestMatch() returns, or an empty string if there is
/// none.
std::string didYouMean(std::string_view text, std::span<const std::string_view> candidates);

/// Returns the names separated by commas: "a, b, c".
std::string commaSeparated(std::span<const std::string_view> names);

/// Returns the names as alternatives: "a", "a or b", "a, b or c".
std::string alternatives(std::span<const std::string_view> names);

/// Returns whether `text` is valid UTF-8 (RFC 3629), which all text in messages must be.
bool isUtf8(std::string_view text);

/// Returns printable(text, 60) in single quotes.
std::string inQuotes(std::string_view text);

/// Returns `text` with "?" in place of every byte that is a control character or not valid UTF-8. A text of more than
/// `maxBytes` bytes is cut off there, after a whole character, and "…" is appended.
std::string printable(std::string_view text, std::size_t maxBytes);

/// Returns the shortest decimal text from which the same double can be read back. Writes all digits of an integer
/// within ±2^53.
std::string shortestDecimal(double value);

/// Returns a number as a person reads it: rounded to six significant digits, without trailing zeros, with the minus
/// sign U+2212. Writes all digits of an integer within ±2^53, and an exponent only below 1e-5 and from 1e15.
std::string roundedDecimal(double value);

/// Returns what a message says of a number outside its bounds: "from −2 to 2 circumradii, not 3" for the unit
/// " circumradii". Rounds the numbers as roundedDecimal() does, unless the number would then equal a bound.
std::string outsideBounds(double least, double most, std::string_view unit, double value);

}  // namespace oval4d::text
