#pragma once
// Text for messages: suggestions ("did you mean …?"), lists, quotes and numbers.

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace oval4d::text {

/// The candidate with the smallest edit distance from `text`; among equals, the first with the length of `text`, else
/// the first. Empty if more than half of that candidate's bytes would have to change.
std::string_view nearest(std::string_view text, std::span<const std::string_view> candidates);

/// Returns " (did you mean 'x'?)" with the nearest candidate, or an empty string if there is none.
std::string didYouMean(std::string_view text, std::span<const std::string_view> candidates);

/// The names separated by commas: "a, b, c".
std::string listed(std::span<const std::string_view> names);

/// The names as alternatives: "a", "a or b", "a, b or c".
std::string alternatives(std::span<const std::string_view> names);

/// Whether `text` is valid UTF-8 (RFC 3629), as all text in messages must be.
bool isUtf8(std::string_view text);

/// `text` in single quotes, as printable() returns it for at most 60 bytes.
std::string inQuotes(std::string_view text);

/// `text` with "?" for everything that is not printable UTF-8, truncated with "…" after about `maxBytes` bytes.
std::string printable(std::string_view text, std::size_t maxBytes);

/// The shortest decimal text of a number that reads back as the same double.
std::string shortest(double value);

}  // namespace oval4d::text
