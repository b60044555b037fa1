#pragma once
// The shape of a 4-D array.

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace oval4d::fields {

/// The numbers of samples along x, y, z and w.
using Shape = std::array<std::size_t, 4>;

/// The maximum number of samples along an axis. A function is evaluated at points of 32-bit floats, which cannot
/// distinguish more positions.
inline constexpr std::size_t kMaxSamplesPerAxis = std::size_t{1} << 24U;

/// The maximum number of samples in an array, so that computations with indices and sizes in bytes do not overflow.
inline constexpr std::size_t kMaxSamples = std::size_t{1} << 44U;

/// Returns the number of samples of an array with this shape, or 0 if the shape is not valid. A valid shape has 1 to
/// kMaxSamplesPerAxis samples along each axis, and at most kMaxSamples in all.
constexpr std::size_t sampleCount(const Shape& shape) {
    std::size_t count = 1;
    for (const std::size_t samples : shape) {
        if (samples == 0 || samples > kMaxSamplesPerAxis || samples > kMaxSamples / count) return 0;
        count *= samples;
    }
    return count;
}

}  // namespace oval4d::fields
