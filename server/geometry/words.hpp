#pragma once
// Names as texts: words, lists, likeness.

#include <string>
#include <string_view>
#include <vector>

namespace oval4d::geometry {

/// The parts of "a,b,c".
std::vector<std::string_view> listOf(std::string_view text);

/// Words in lower case; blanks, hyphens and underscores stand between them.
std::vector<std::string> wordsOf(std::string_view text);

/// Words with a blank between, from `first` to before `end`.
std::string joined(const std::vector<std::string>& words, std::size_t first, std::size_t end);

/// Lower case, without blanks, hyphens and underscores: what names are compared by.
std::string folded(std::string_view text);

}  // namespace oval4d::geometry
