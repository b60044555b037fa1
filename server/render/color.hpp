#pragma once
// Converts colors to the number format of vertex attributes.

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "scene/scene.hpp"

namespace oval4d::render {

/// Returns the color `color` with the opacity `alpha` (clamped to 0 … 1) as a number. In the memory of a little-endian
/// machine, the bytes of the number are R, G, B and A, in this order. R, G and B are not multiplied by alpha.
inline std::uint32_t rgba(scene::Color color, float alpha) {
    const auto a = static_cast<std::uint32_t>(std::lround(std::clamp(alpha, 0.0f, 1.0f) * 255));
    return (color >> 16 & 255) | (color & 0xff00) | (color & 255) << 16 | a << 24;
}

}  // namespace oval4d::render
