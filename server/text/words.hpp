#pragma once
// Functions that split text into words, join words, and normalize names, so that different spellings compare equal.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace oval4d::text {

/// Returns the parts of a comma-separated list: "a", "b" and "c" for "a,b,c". A comma at the end of the text does not
/// add an empty part. The parts are views into `text`.
std::vector<std::string_view> splitAtCommas(std::string_view text);

/// Returns the words of a text in lowercase. White space, hyphens and underscores separate words.
std::vector<std::string> lowerCaseWords(std::string_view text);

/// Returns words[first] … words[end − 1], separated by spaces.
std::string joined(const std::vector<std::string>& words, std::size_t first, std::size_t end);

/// Returns the text in lowercase, without white space, hyphens and underscores. Names with equal results denote the
/// same thing.
std::string normalizedName(std::string_view text);

/// Returns the number of bytes of the space character at the beginning of a UTF-8 text, if this is U+00A0, U+2000 to
/// U+200A, U+202F, U+205F or U+3000. Returns 0 otherwise, also for the ASCII space.
std::size_t leadingUnicodeSpaceLength(std::string_view text);

/// Returns the text with U+0020 in place of each space that leadingUnicodeSpaceLength() recognizes. An example is the
/// no-break space between a number and its unit.
std::string withPlainBlanks(std::string_view text);

/// Returns the text without spaces and tabs at its ends.
std::string_view trimmed(std::string_view text);

}  // namespace oval4d::text
