#pragma once
// Converts coordinates and indices, the bulk of the messages, to decimal text faster than std::to_chars.

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace oval4d::text {

/// Whether the number is an integer within ±2^53, the range in which doubles represent every integer. False for −0,
/// whose sign an integer would lose.
inline bool isExactInteger(double number) {
    return std::abs(number) <= 0x1p53 && std::trunc(number) == number && !(number == 0 && std::signbit(number));
}

/// Bytes that the buffer must have for each number and the brackets and commas after it. The buffer needs this once
/// more at its end, because these functions may write beyond the end of the text.
inline constexpr std::size_t kNumberRoom = 20;

/// Writes vectors as JSON, such as "[1,0.5,0.25],[1,1,0]"; writes nothing for an empty list. Returns the end of the
/// text. Each number, rounded to a float, has the fewest digits that read back as the same float, rarely one more.
/// Integers within ±2^53 have all their digits and no exponent. All numbers must be finite.
char* putVectors(char* at, std::span<const glm::dvec3> list);
char* putVectors(char* at, std::span<const glm::dvec4> list);

/// The decimal text of each number below 10,000: its characters from the low byte on, its length in the high byte.
extern const std::array<std::uint64_t, 10'000> kSmallIntegerTexts;

char* putLargeInteger(char* at, std::uint32_t number);

/// Writes an integer, and returns the end of the text.
inline char* putInteger(char* at, std::uint32_t number) {
    static_assert(std::endian::native == std::endian::little, "the low byte comes first");
    if (number >= kSmallIntegerTexts.size()) return putLargeInteger(at, number);
    std::memcpy(at, &kSmallIntegerTexts[number], sizeof kSmallIntegerTexts[number]);
    return at + (kSmallIntegerTexts[number] >> 56U);
}

}  // namespace oval4d::text
