#pragma once
// "Did you mean …?"

#include <span>
#include <string>
#include <string_view>

namespace oval4d::protocol {

/// The candidate nearest to `text` by edit distance (of equals the first of its own length), or empty if none is near:
/// more than half of the candidate's letters would have to change.
std::string_view nearest(std::string_view text, std::span<const std::string_view> candidates);

/// " (did you mean 'x'?)" or nothing.
std::string didYouMean(std::string_view text, std::span<const std::string_view> candidates);

/// "a, b, c".
std::string listed(std::span<const std::string_view> names);

/// `text` in single quotes, shortened to a length that fits a sentence, what is not printable UTF-8 replaced.
std::string inQuotes(std::string_view text);

/// The shortest text of a number that reads back as the same double.
std::string shortest(double value);

}  // namespace oval4d::protocol
