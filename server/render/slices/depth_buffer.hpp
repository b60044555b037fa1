#pragma once
// The values of the depth buffer that the rasterizers share.

#include <bit>
#include <cstdint>

namespace oval4d::render {

/// The depth buffer holds one float per pixel: the nearness of the nearest solid shape, that is, 1 / (its distance from
/// the eye along the view axis), or 0 if there is none. The lowest 8 bits of the float, which this mask selects, hold
/// the coverage instead: the part of the pixel that solid shapes cover, from 0 to 255. The other bits give the nearness
/// with a relative error of at most 1/30,000. Without the coverage, the background would show along the edges of solid
/// shapes that are in front of translucent ones.
inline constexpr std::uint32_t kCoverageBits = 255;

/// Returns the depth buffer's value for a pixel that a shape with this nearness covers completely.
inline float packFullyCovered(float nearness) {
    return std::bit_cast<float>(std::bit_cast<std::uint32_t>(nearness) | kCoverageBits);
}

/// Returns the part of a pixel, from 0 to 1, that solid shapes leave uncovered. `depth` is the value of the pixel in
/// the depth buffer.
inline float unpackUncoveredPart(float depth) {
    return 1 - static_cast<float>(std::bit_cast<std::uint32_t>(depth) & kCoverageBits) / kCoverageBits;
}

}  // namespace oval4d::render
