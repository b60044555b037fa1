#pragma once
// The format of the values in the depth buffer that the rasterizers (which draw without OpenGL) share.

#include <bit>
#include <cstdint>

namespace oval4d::render {

/// Selects the coverage bits of a value of the depth buffer. The depth buffer holds one float per pixel: the nearness
/// of the nearest solid shape, or 0 if there is none. The nearness is 1 / (the distance from the eye along the view
/// axis). The lowest 8 bits of the float, which this mask selects, hold the coverage instead: the part of the pixel
/// that solid shapes cover, from 0 to 255. The other bits give the nearness with a relative error of at most 1/30,000.
/// Without the coverage, the background would show along the edges of solid shapes that are in front of translucent
/// shapes.
inline constexpr std::uint32_t kCoverageBits = 255;

/// Returns the value of the depth buffer for a pixel that a shape with the nearness `nearness` covers completely.
inline float packFullyCoveredDepth(float nearness) {
    return std::bit_cast<float>(std::bit_cast<std::uint32_t>(nearness) | kCoverageBits);
}

/// Returns the part of a pixel, from 0 to 1, that solid shapes leave uncovered. `depth` is the value of the pixel in
/// the depth buffer.
inline float unpackUncoveredFraction(float depth) {
    return 1 - static_cast<float>(std::bit_cast<std::uint32_t>(depth) & kCoverageBits) / kCoverageBits;
}

}  // namespace oval4d::render
