#pragma once
// Converts coordinates and indices, which make up most of the messages, to decimal text faster than std::to_chars.

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

/// Returns whether the number is an integer within ±2^53, the range in which doubles represent every integer. Returns
/// false for −0, because an integer type cannot represent its sign.
inline bool isExactInteger(double number) {
    return std::abs(number) <= 0x1p53 && std::trunc(number) == number && !(number == 0 && std::signbit(number));
}

/// The number of bytes to reserve in the buffer for each number, including the brackets and commas after it. The buffer
/// must have room for one number more than will be written, because putVectorsAsJson() and putInteger() may write
/// beyond the end of the text.
inline constexpr std::size_t kBytesPerNumber = 20;

/// Writes vectors as JSON at `at`, such as "[1,0.5,0.25],[1,1,0]"; writes nothing for an empty list. Returns the end of
/// the text. Rounds each number to a float and writes the fewest digits from which the same float can be read back; in
/// rare cases, writes one digit more. Writes integers within ±2^53 with all their digits and without an exponent. All
/// numbers must be finite.
char* putVectorsAsJson(char* at, std::span<const glm::dvec3> list);
char* putVectorsAsJson(char* at, std::span<const glm::dvec4> list);

/// The decimal text of each number below 10,000, as an integer: the first character is in the lowest byte, the next
/// ones in the bytes above it, and the number of characters is in the highest byte.
extern const std::array<std::uint64_t, 10'000> kSmallIntegerTexts;

/// Writes an integer of at least 10,000, and returns the end of the text. Called by putInteger().
char* putLargeInteger(char* at, std::uint32_t number);

/// Writes an integer at `at`, and returns the end of the text. May overwrite up to 7 bytes after the end.
inline char* putInteger(char* at, std::uint32_t number) {
    static_assert(std::endian::native == std::endian::little, "the low byte comes first");
    if (number >= kSmallIntegerTexts.size()) return putLargeInteger(at, number);
    std::memcpy(at, &kSmallIntegerTexts[number], sizeof kSmallIntegerTexts[number]);
    return at + (kSmallIntegerTexts[number] >> 56U);
}

}  // namespace oval4d::text
