#pragma once
// The values of the depth buffer that the rasterizers share.

#include <bit>
#include <cstdint>

namespace oval4d::render {

/// The depth buffer holds one float per pixel: the nearness of the nearest solid shape, which is 1 / (distance from the
/// eye along the view axis), or 0. These bits, the lowest ones, hold the part of the pixel that solid shapes cover,
/// from 0 to 255, so that the nearness is precise to 1/30,000. Without this part, the background would show along the
/// edges of solid shapes that are in front of translucent ones.
inline constexpr std::uint32_t kCoverageBits = 255;

/// Returns the value for a pixel that is covered completely by a shape with this nearness.
inline float coveredAt(float nearness) {
    return std::bit_cast<float>(std::bit_cast<std::uint32_t>(nearness) | kCoverageBits);
}

/// Returns the part of a pixel that solid shapes leave uncovered, from 0 to 1.
inline float uncoveredPart(float depth) {
    return 1 - static_cast<float>(std::bit_cast<std::uint32_t>(depth) & kCoverageBits) / kCoverageBits;
}

}  // namespace oval4d::render
