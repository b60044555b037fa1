#pragma once
// Appends numbers in little-endian byte order to the bytes of a file.

#include <bit>
#include <cstdint>
#include <string>

#include <glm/vec3.hpp>

namespace oval4d::exports {

template <std::unsigned_integral Number>
void putLittleEndian(std::string& out, Number number) {
    for (std::size_t i = 0; i < sizeof number; ++i) out += static_cast<char>(number >> (8 * i) & 0xffU);
}
inline void putLittleEndian(std::string& out, float number) {
    putLittleEndian(out, std::bit_cast<std::uint32_t>(number));
}
/// Appends x, y and z as 32-bit floats.
inline void putLittleEndian(std::string& out, const glm::dvec3& point) {
    for (int i = 0; i < 3; ++i) putLittleEndian(out, static_cast<float>(point[i]));
}

}  // namespace oval4d::exports
