#pragma once
// Converts coordinates and indices to decimal text, faster than std::to_chars. Most of the text of messages consists of
// such numbers.

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

/// Returns whether a number is an integer within ±2^53, where doubles represent every integer exactly. Returns false
/// for −0, because integer types cannot represent its sign.
inline bool isExactInteger(double number) {
    return std::abs(number) <= 0x1p53 && std::trunc(number) == number && !(number == 0 && std::signbit(number));
}

/// The number of bytes to reserve in the buffer for each number, including brackets and commas. The caller must reserve
/// room for one number more than it writes, because putVectorsAsJson() and putInteger() may write beyond the end of the
/// text.
inline constexpr std::size_t kBytesPerNumber = 20;

/// Writes vectors as JSON at `at`, such as "[1,0.5,0.25],[1,1,0]". Writes nothing for an empty list. Returns the end of
/// the text. Each number is rounded to a float. Its text has the fewest digits from which the same float can be read
/// back; rarely, one digit more. Integers within ±2^53 have all their digits and no exponent. All numbers must be
/// finite.
char* putVectorsAsJson(char* at, std::span<const glm::dvec3> list);
char* putVectorsAsJson(char* at, std::span<const glm::dvec4> list);

/// The decimal text of each number below 10,000, packed into an integer. The lowest byte is the first character, and
/// the higher bytes are the next characters. The highest byte is the number of characters.
extern const std::array<std::uint64_t, 10'000> kSmallIntegerTexts;

/// Writes an integer of at least 10,000 for putInteger(), and returns the end of the text.
char* putLargeInteger(char* at, std::uint32_t number);

/// Writes an integer at `at`, and returns the end of the text. May overwrite up to 7 bytes after this end.
inline char* putInteger(char* at, std::uint32_t number) {
    static_assert(std::endian::native == std::endian::little, "the low byte comes first");
    if (number >= kSmallIntegerTexts.size()) return putLargeInteger(at, number);
    std::memcpy(at, &kSmallIntegerTexts[number], sizeof kSmallIntegerTexts[number]);
    return at + (kSmallIntegerTexts[number] >> 56U);
}

}  // namespace oval4d::text
