#pragma once
// Numbers as decimal text, faster than std::to_chars for those that messages are full of: coordinates and indices.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace oval4d::protocol {

/// Room to keep free for each number and the brackets and commas after it, and once more: what is written beyond a
/// text's end stays within it too.
inline constexpr std::size_t kNumberRoom = 20;

/// Writes vectors as JSON: "[1,0.5,0.25],[1,1,0]", nothing for none; returns the text's end. Each number has the fewest
/// digits that read back as the same float, rarely one more. All must be finite.
char* putVectors(char* at, std::span<const glm::dvec3> list);
char* putVectors(char* at, std::span<const glm::dvec4> list);

/// For each number the characters of its text, from the low byte on, and its length in the high byte.
extern const std::array<std::uint64_t, 10'000> kTexts;

char* putLarge(char* at, std::uint32_t number);

/// Writes an integer; returns its end.
inline char* putInteger(char* at, std::uint32_t number) {
    static_assert(std::endian::native == std::endian::little, "the low byte comes first");
    if (number >= kTexts.size()) return putLarge(at, number);
    std::memcpy(at, &kTexts[number], sizeof kTexts[number]);
    return at + (kTexts[number] >> 56U);
}

}  // namespace oval4d::protocol
