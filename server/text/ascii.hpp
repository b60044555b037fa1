#pragma once
// Tests for ASCII digits and letters, independent of the locale.

namespace oval4d::text {

constexpr bool isDigit(char c) { return c >= '0' && c <= '9'; }
constexpr bool isLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

}  // namespace oval4d::text
