#include "fields/array/interpolation_avx2.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>

#include "fields/array/cell.hpp"
#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace oval4d::fields::avx2 {

#if defined(__x86_64__)

namespace {

// Compiles a function for AVX2 without FMA, because the portable code, too, rounds products before it adds them.
#define OVAL4D_AVX2 [[gnu::target("avx2")]]

constexpr std::size_t kLanes = ScalarFunction::kLanes;

// While the values of a group of 8 points are computed, the samples for another group are prefetched: the one kAhead
// groups later. Only the samples for every second point are prefetched, because neighboring points often share cache
// lines.
constexpr std::size_t kAhead = 4;

// The members of a LatticeAxis, each copied to all lanes.
struct LatticeAxisLanes {
    __m256 origin, scale, shift, last, lastCell;
    __m256d stride;
};

// The cells of eight points. For each point: the index of the cell's first sample, the position in the cell, and
// whether a coordinate of the point is NaN.
struct LatticeCellLanes {
    std::array<std::int64_t, kLanes> first;
    __m256 t[4], nan;
};

// One row of samples from each of four cells, or numbers interpolated from such rows. Each cell has a pair of
// neighboring numbers: the number at the lower x, then that at the upper x.
using PairLanes = __m256;

// The results of the interpolation along w, z and y in four cells: the values, and the derivatives along y, z and w.
struct InterpolatedAlongWzy {
    PairLanes value, dy, dz, dw;
};

OVAL4D_AVX2 inline __m256 mix(__m256 a, __m256 b, __m256 t) {
    return _mm256_add_ps(a, _mm256_mul_ps(t, _mm256_sub_ps(b, a)));
}

// Writes four whole numbers from 0 to 2^51 to `to` as integers: adds 2^52, which moves a number to the low bits of the
// sum.
OVAL4D_AVX2 inline void storeAsIntegers(__m256d numbers, std::int64_t* to) {
    const __m256d rounder = _mm256_set1_pd(0x1p52);
    const __m256d integers = _mm256_xor_pd(_mm256_add_pd(numbers, rounder), rounder);
    std::memcpy(to, &integers, sizeof integers);
}

// Sets `cells` to the cells that contain the kLanes points from the index `begin` on.
OVAL4D_AVX2 inline void locateCells(const LatticeAxisLanes* axes, const PointBatch& points, std::size_t begin,
                                    LatticeCellLanes& cells) {
    const __m256 at[4] = {_mm256_loadu_ps(&points.x[begin]), _mm256_loadu_ps(&points.y[begin]),
                          _mm256_loadu_ps(&points.z[begin]), _mm256_loadu_ps(&points.w[begin])};
    cells.nan = _mm256_or_ps(_mm256_cmp_ps(at[0], at[1], _CMP_UNORD_Q), _mm256_cmp_ps(at[2], at[3], _CMP_UNORD_Q));
    __m256d low = _mm256_setzero_pd(), high = low;
    for (std::size_t i = 0; i < 4; ++i) {
        const LatticeAxisLanes& axis = axes[i];
        __m256 position = _mm256_add_ps(_mm256_mul_ps(_mm256_sub_ps(at[i], axis.origin), axis.scale), axis.shift);
        position = _mm256_min_ps(_mm256_max_ps(position, _mm256_setzero_ps()), axis.last);  // NaN becomes 0
        const __m256 cell = _mm256_min_ps(_mm256_floor_ps(position), axis.lastCell);
        cells.t[i] = _mm256_sub_ps(position, cell);
        const __m256d lowCell = _mm256_cvtps_pd(_mm256_castps256_ps128(cell));
        const __m256d highCell = _mm256_cvtps_pd(_mm256_extractf128_ps(cell, 1));
        low = _mm256_add_pd(low, _mm256_mul_pd(lowCell, axis.stride));
        high = _mm256_add_pd(high, _mm256_mul_pd(highCell, axis.stride));
    }
    storeAsIntegers(low, cells.first.data());
    storeAsIntegers(high, cells.first.data() + 4);
}

inline void prefetch(const float* samples, const CellRowOffsets& offsets, const LatticeCellLanes& cells) {
    for (std::size_t i = 0; i < kLanes; i += 2) {
        for (const std::size_t offset : offsets) __builtin_prefetch(samples + cells.first[i] + offset);
    }
}

inline double loadPair(const float* at) {
    double pair;
    std::memcpy(&pair, at, sizeof pair);
    return pair;
}

// Loads one row from each of four cells. Does not use gather instructions, because they are slower on some processors.
OVAL4D_AVX2 inline PairLanes loadRows(const float* samples, const std::int64_t* first) {
    return _mm256_castpd_ps(_mm256_set_pd(loadPair(samples + first[3]), loadPair(samples + first[2]),
                                          loadPair(samples + first[1]), loadPair(samples + first[0])));
}

// Interpolates along w, z and y in four cells. `first` holds the indices of the cells' first samples. y, z and w are
// the positions in the cells; each position occurs twice, once for each number of a pair.
template <bool kGradient>
OVAL4D_AVX2 inline void interpolateAlongWzy(const float* samples, const CellRowOffsets& offsets,
                                            const std::int64_t* first, const __m256& y, const __m256& z,
                                            const __m256& w, InterpolatedAlongWzy& out) {
    PairLanes rows[kCellRows];
    for (std::size_t row = 0; row < kCellRows; ++row) rows[row] = loadRows(samples + offsets[row], first);
    PairLanes v[4];  // at (y, z) = (0, 0), (1, 0), (0, 1), (1, 1) of the cells
    for (std::size_t i = 0; i < 4; ++i) v[i] = mix(rows[i], rows[i + 4], w);
    const PairLanes y0 = mix(v[0], v[2], z), y1 = mix(v[1], v[3], z);
    out.value = mix(y0, y1, y);
    if constexpr (kGradient) {
        PairLanes dw[4];
        for (std::size_t i = 0; i < 4; ++i) dw[i] = _mm256_sub_ps(rows[i + 4], rows[i]);
        out.dy = _mm256_sub_ps(y1, y0);
        out.dz = mix(_mm256_sub_ps(v[2], v[0]), _mm256_sub_ps(v[3], v[1]), y);
        out.dw = mix(mix(dw[0], dw[2], z), mix(dw[1], dw[3], z), y);
    }
}

// The numbers at the lower x and at the upper x of eight cells.
struct ValuesAtXEnds {
    __m256 low, high;
};

OVAL4D_AVX2 inline void splitXEnds(const PairLanes& firstFour, const PairLanes& lastFour, ValuesAtXEnds& ends) {
    const __m256i evenThenOdd = _mm256_setr_epi32(0, 2, 4, 6, 1, 3, 5, 7);
    const __m256 a = _mm256_permutevar8x32_ps(firstFour, evenThenOdd);
    const __m256 b = _mm256_permutevar8x32_ps(lastFour, evenThenOdd);
    ends = {_mm256_permute2f128_ps(a, b, 0x20), _mm256_permute2f128_ps(a, b, 0x31)};
}

OVAL4D_AVX2 inline __m256 interpolateAlongX(const PairLanes& firstFour, const PairLanes& lastFour, const __m256& x) {
    ValuesAtXEnds ends;
    splitXEnds(firstFour, lastFour, ends);
    return mix(ends.low, ends.high, x);
}

OVAL4D_AVX2 inline __m256 isFinite(const __m256& numbers) {
    const __m256 magnitude = _mm256_andnot_ps(_mm256_set1_ps(-0.F), numbers);
    return _mm256_cmp_ps(magnitude, _mm256_set1_ps(std::numeric_limits<float>::max()), _CMP_LE_OQ);
}

// Returns a mask of the lanes whose points lie on a face of their cell, so that some corners have the weight 0.
OVAL4D_AVX2 inline __m256 maskOfPointsOnFaces(const LatticeCellLanes& cells) {
    __m256 faces = _mm256_setzero_ps();
    for (const __m256& t : cells.t) {
        const __m256 lower = _mm256_cmp_ps(t, _mm256_setzero_ps(), _CMP_EQ_OQ);
        const __m256 upper = _mm256_cmp_ps(t, _mm256_set1_ps(1), _CMP_EQ_OQ);
        faces = _mm256_or_ps(faces, _mm256_or_ps(lower, upper));
    }
    return faces;
}

template <bool kGradient>
OVAL4D_AVX2 void interpolateBatch(const SampledLattice& from, const PointBatch& points, std::span<float> values,
                                  const GradientBatch& gradients) {
    LatticeAxisLanes axes[4];
    for (std::size_t i = 0; i < 4; ++i) {
        const LatticeAxis& axis = from.lattice.axes[i];
        axes[i] = {_mm256_set1_ps(axis.origin),   _mm256_set1_ps(axis.scale),
                   _mm256_set1_ps(axis.shift),    _mm256_set1_ps(axis.last),
                   _mm256_set1_ps(axis.lastCell), _mm256_set1_pd(static_cast<double>(axis.stride))};
    }
    const CellRowOffsets offsets = cellRowOffsets(from.lattice);
    const __m256i firstFour = _mm256_setr_epi32(0, 0, 1, 1, 2, 2, 3, 3);
    const __m256i lastFour = _mm256_setr_epi32(4, 4, 5, 5, 6, 6, 7, 7);
    LatticeCellLanes upcoming[kAhead];  // the cells of the next kAhead groups; group g has the index g % kAhead
    for (std::size_t i = 0; i < std::min(points.size(), kAhead * kLanes); i += kLanes)
        locateCells(axes, points, i, upcoming[i / kLanes]);
    for (std::size_t i = 0; i < points.size(); i += kLanes) {
        LatticeCellLanes& next = upcoming[i / kLanes % kAhead];
        const LatticeCellLanes cells = next;
        if (const std::size_t ahead = i + kAhead * kLanes; ahead < points.size()) {
            locateCells(axes, points, ahead, next);
            prefetch(from.samples, offsets, next);
        }
        const __m256* const t = cells.t;
        InterpolatedAlongWzy first, last;
        interpolateAlongWzy<kGradient>(
            from.samples, offsets, cells.first.data(), _mm256_permutevar8x32_ps(t[1], firstFour),
            _mm256_permutevar8x32_ps(t[2], firstFour), _mm256_permutevar8x32_ps(t[3], firstFour), first);
        interpolateAlongWzy<kGradient>(
            from.samples, offsets, cells.first.data() + 4, _mm256_permutevar8x32_ps(t[1], lastFour),
            _mm256_permutevar8x32_ps(t[2], lastFour), _mm256_permutevar8x32_ps(t[3], lastFour), last);
        ValuesAtXEnds ends;
        splitXEnds(first.value, last.value, ends);
        const __m256 value = mix(ends.low, ends.high, t[0]);
        const __m256 finite = isFinite(value);
        const __m256 valid = _mm256_andnot_ps(cells.nan, finite);
        _mm256_storeu_ps(&values[i], _mm256_blendv_ps(_mm256_set1_ps(kNoValue), value, valid));
        if constexpr (kGradient) {
            const __m256 x = _mm256_mul_ps(_mm256_sub_ps(ends.high, ends.low), axes[0].scale);
            const __m256 y = _mm256_mul_ps(interpolateAlongX(first.dy, last.dy, t[0]), axes[1].scale);
            const __m256 z = _mm256_mul_ps(interpolateAlongX(first.dz, last.dz, t[0]), axes[2].scale);
            const __m256 w = _mm256_mul_ps(interpolateAlongX(first.dw, last.dw, t[0]), axes[3].scale);
            const __m256 exists = _mm256_andnot_ps(cells.nan, _mm256_and_ps(_mm256_and_ps(isFinite(x), isFinite(y)),
                                                                            _mm256_and_ps(isFinite(z), isFinite(w))));
            _mm256_storeu_ps(&gradients.x[i], _mm256_and_ps(x, exists));
            _mm256_storeu_ps(&gradients.y[i], _mm256_and_ps(y, exists));
            _mm256_storeu_ps(&gradients.z[i], _mm256_and_ps(z, exists));
            _mm256_storeu_ps(&gradients.w[i], _mm256_and_ps(w, exists));
        }
        if (_mm256_movemask_ps(valid) == 0xff) continue;
        // At a point on a face of its cell, a corner that is not finite may have the weight 0. If the result at such a
        // point is not finite, CellPoint::value(), which handles this case, computes the value again.
        const int unknown =
            _mm256_movemask_ps(_mm256_andnot_ps(_mm256_or_ps(finite, cells.nan), maskOfPointsOnFaces(cells)));
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            if ((unknown >> lane & 1) == 0) continue;
            const std::size_t j = i + lane;
            values[j] = CellPoint(from, offsets, {points.x[j], points.y[j], points.z[j], points.w[j]}).value();
        }
    }
}

#undef OVAL4D_AVX2

}  // namespace

bool isSupported() { return __builtin_cpu_supports("avx2") != 0; }

void interpolate(const SampledLattice& from, const PointBatch& points, std::span<float> values,
                 const GradientBatch* gradients) {
    if (gradients != nullptr)
        interpolateBatch<true>(from, points, values, *gradients);
    else
        interpolateBatch<false>(from, points, values, {});
}

#else

bool isSupported() { return false; }
void interpolate(const SampledLattice& /*from*/, const PointBatch& /*points*/, std::span<float> /*values*/,
                 const GradientBatch* /*gradients*/) {}

#endif

}  // namespace oval4d::fields::avx2
