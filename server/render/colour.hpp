#pragma once
// Colours as vertices carry them.

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "scene/scene.hpp"

namespace oval4d::render {

/// The bytes R, G, B, A in memory's order on a little-endian machine.
inline std::uint32_t rgba(scene::Colour colour, float alpha) {
    const auto a = static_cast<std::uint32_t>(std::lround(std::clamp(alpha, 0.0f, 1.0f) * 255));
    return (colour >> 16 & 255) | (colour & 0xff00) | (colour & 255) << 16 | a << 24;
}

}  // namespace oval4d::render
