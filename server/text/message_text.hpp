#pragma once
// Text for messages to users: suggestions ("did you mean …?"), lists, quotes and numbers.

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace oval4d::text {

/// Returns the candidate with the smallest edit distance (Levenshtein) from the first 60 bytes of `text`. Among several
/// candidates with this distance, prefers candidates that are as long as `text`, and then the first one. Leaves out
/// candidates whose distance is more than about half their length. Returns an empty string if no candidate is left.
std::string_view closestMatch(std::string_view text, std::span<const std::string_view> candidates);

/// Returns " (did you mean 'x'?)", where x is the result of closestMatch(). Returns an empty string if closestMatch()
/// finds no candidate.
std::string didYouMean(std::string_view text, std::span<const std::string_view> candidates);

/// Returns the names separated by commas: "a, b, c".
std::string commaSeparated(std::span<const std::string_view> names);

/// Returns the names as alternatives: "a", "a or b", "a, b or c".
std::string joinedWithOr(std::span<const std::string_view> names);

/// Returns whether `text` is valid UTF-8 (RFC 3629). All text in messages must be valid UTF-8.
bool isUtf8(std::string_view text);

/// Returns printable(text, 60) in single quotes.
std::string inQuotes(std::string_view text);

/// Returns `text` with "?" in place of every byte that is an ASCII control character or not valid UTF-8. Keeps only the
/// characters that begin within the first `maxBytes` bytes, and appends "…" if there are more.
std::string printable(std::string_view text, std::size_t maxBytes);

/// Returns the shortest decimal text from which the same double can be read back. Integers within ±2^53 have all their
/// digits.
std::string shortestDecimal(double value);

/// Returns a number for people to read: rounded to six significant digits, without trailing zeros, with the minus sign
/// U+2212. Integers within ±2^53 have all their digits. Other numbers have an exponent if their absolute value is less
/// than 1e-5 or at least 1e15.
std::string roundedDecimal(double value);

/// Returns the part of an error message about a value outside the bounds `least` and `most`, such as "from −2 to 2
/// circumradii, not 3" for the unit " circumradii". Rounds all three numbers with roundedDecimal(). If the value would
/// then look equal to a bound, writes all three numbers with shortestDecimal().
std::string outsideBoundsText(double least, double most, std::string_view unit, double value);

}  // namespace oval4d::text
