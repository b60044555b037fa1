#pragma once
// Splits, joins and compares names.

#include <string>
#include <string_view>
#include <vector>

namespace oval4d::text {

/// The parts of a comma-separated list, such as "a,b,c".
std::vector<std::string_view> listOf(std::string_view text);

/// The words of a text in lower case; white space, hyphens and underscores separate them.
std::vector<std::string> wordsOf(std::string_view text);

/// Joins words[first] … words[end − 1] with spaces.
std::string joined(const std::vector<std::string>& words, std::size_t first, std::size_t end);

/// The text in lower case, without white space, hyphens and underscores, for comparing names.
std::string folded(std::string_view text);

/// The text without blanks and tabs at its ends.
std::string_view trimmed(std::string_view text);

}  // namespace oval4d::text
