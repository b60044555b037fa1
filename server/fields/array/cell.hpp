#pragma once
// Quadrilinear interpolation at one point. This portable code gives the same bits as the code with AVX2.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "fields/array/interpolation.hpp"

namespace oval4d::fields {

inline constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();

inline bool isFinite(float value) { return std::abs(value) <= std::numeric_limits<float>::max(); }

/// The number of rows of a cell. A row is a pair of samples that are neighbors along x.
inline constexpr std::size_t kCellRows = 8;

/// For each row of a cell, the distance in memory from the cell's first sample to the row's first sample, in samples.
/// Bit 0 of a row's index is set if the row lies at the upper end of the cell along y; bit 1 and bit 2 likewise for z
/// and w.
using CellRowOffsets = std::array<std::size_t, kCellRows>;

inline CellRowOffsets cellRowOffsets(const Lattice& lattice) {
    CellRowOffsets offsets{};
    for (std::size_t row = 0; row < kCellRows; ++row) {
        for (std::size_t i = 0; i < 3; ++i) {
            if ((row >> i & 1U) != 0) offsets[row] += lattice.axes[i + 1].stride;
        }
    }
    return offsets;
}

/// Returns (1 − t) a + t b. If a and b are equal, returns exactly their value.
inline float mix(float a, float b, float t) { return a + t * (b - a); }

/// The interpolated value at a point, and its derivatives along each axis. The derivatives are with respect to the
/// position in the cell, CellPoint::t, not to the coordinates of the point.
struct ValueAndDerivatives {
    float value;
    std::array<float, 4> derivatives;
};

/// A point in a cell: the 16 samples at the cell's corners, and the position in the cell, from 0 to 1 along each axis.
struct CellPoint {
    std::array<float, 2 * kCellRows> corners;  // the sample at the lower x of each row, then that at the upper x of
                                               // each row
    std::array<float, 4> t;

    CellPoint(const SampledLattice& from, const CellRowOffsets& offsets, const std::array<float, 4>& point) {
        const float* samples = from.samples;
        for (std::size_t i = 0; i < 4; ++i) {
            const LatticeAxis& axis = from.lattice.axes[i];
            const float position = axis.continuousIndex(point[i]);
            const auto whole = static_cast<float>(static_cast<std::int32_t>(position));
            const float cell = whole < axis.lastCell ? whole : axis.lastCell;
            samples += static_cast<std::size_t>(cell) * axis.stride;
            t[i] = position - cell;
        }
        for (std::size_t row = 0; row < kCellRows; ++row) {
            corners[row] = samples[offsets[row]];
            corners[row + kCellRows] = samples[offsets[row] + from.lattice.axes[0].stride];
        }
    }

    /// Returns the interpolated value, or NaN if a corner with a nonzero weight is not finite.
    float value() const {
        const float plain =
            interpolateCorners(mix);  // a corner with the weight 0 that is not finite makes this number not finite
        if (isFinite(plain)) return plain;
        const float weighted = interpolateCorners([](float a, float b, float s) {
            return s == 0 ? a : s == 1 ? b : mix(a, b, s);
        });
        return isFinite(weighted) ? weighted : kNoValue;
    }

    /// Returns the interpolated value and its derivatives. If a corner is NaN or infinite, none of these numbers is
    /// finite.
    ValueAndDerivatives valueAndDerivatives() const {
        std::array<std::array<float, 4>, 2> ends{};  // at the lower and the upper x of the cell: the value, and its
                                                     // derivatives along y, z, w
        for (std::size_t x = 0; x < 2; ++x) {
            const float* const c = &corners[x * kCellRows];
            std::array<float, 4> v{}, dw{};  // at (y, z) = (0, 0), (1, 0), (0, 1), (1, 1) of the cell
            for (std::size_t i = 0; i < 4; ++i) {
                v[i] = mix(c[i], c[i + 4], t[3]);
                dw[i] = c[i + 4] - c[i];
            }
            const float y0 = mix(v[0], v[2], t[2]), y1 = mix(v[1], v[3], t[2]);
            ends[x] = {mix(y0, y1, t[1]), y1 - y0, mix(v[2] - v[0], v[3] - v[1], t[1]),
                       mix(mix(dw[0], dw[2], t[2]), mix(dw[1], dw[3], t[2]), t[1])};
        }
        const auto& [low, high] = ends;
        return {mix(low[0], high[0], t[0]),
                {high[0] - low[0], mix(low[1], high[1], t[0]), mix(low[2], high[2], t[0]), mix(low[3], high[3], t[0])}};
    }

  private:
    // Interpolates along w, z, y, and then x. Each step calls `mixed`, which has the parameters of mix().
    template <typename Mix>
    float interpolateCorners(const Mix& mixed) const {
        std::array<float, 2> ends{};
        for (std::size_t x = 0; x < 2; ++x) {
            const float* const c = &corners[x * kCellRows];
            const float y0 = mixed(mixed(c[0], c[4], t[3]), mixed(c[2], c[6], t[3]), t[2]);
            const float y1 = mixed(mixed(c[1], c[5], t[3]), mixed(c[3], c[7], t[3]), t[2]);
            ends[x] = mixed(y0, y1, t[1]);
        }
        return mixed(ends[0], ends[1], t[0]);
    }
};

}  // namespace oval4d::fields
