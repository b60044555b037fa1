#pragma once
// Functions that split text into words, join words, and normalize names for comparison.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace oval4d::text {

/// Returns the parts of a comma-separated list: "a", "b" and "c" for "a,b,c". A comma at the end of the text does not
/// begin a further, empty part. The parts refer to the memory of `text`.
std::vector<std::string_view> splitAtCommas(std::string_view text);

/// Returns the words of a text in lower case. White space, hyphens and underscores separate words.
std::vector<std::string> lowerCaseWords(std::string_view text);

/// Returns words[first] … words[end − 1], separated by spaces.
std::string joined(const std::vector<std::string>& words, std::size_t first, std::size_t end);

/// Returns the text in lower case, without white space, hyphens and underscores. Two names denote the same thing if
/// their normalized names are equal.
std::string normalizedName(std::string_view text);

/// If a UTF-8 text begins with a space character that is not ASCII (U+00A0, U+2000 to U+200A, U+202F, U+205F or
/// U+3000), returns the number of bytes of this character; otherwise 0.
std::size_t leadingUnicodeSpace(std::string_view text);

/// Returns the text with U+0020 in place of each space that leadingUnicodeSpace() recognizes, such as the no-break
/// space between a number and its unit.
std::string withPlainBlanks(std::string_view text);

/// Returns the text without spaces and tabs at its ends.
std::string_view trimmed(std::string_view text);

}  // namespace oval4d::text
