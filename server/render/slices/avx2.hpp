#pragma once
// Operations on eight numbers or eight pixels at a time, for processors with AVX2 and FMA.

#if defined(__x86_64__)

#include <immintrin.h>

#include <cstddef>

/// Marks a function that is compiled for processors with AVX2 and FMA. The function must be called only on such
/// processors.
#define OVAL4D_AVX2 __attribute__((target("avx2,fma")))

namespace oval4d::render {

/// Returns base^exponent for eight bases. `exponent` must be at least 1.
OVAL4D_AVX2 inline __m256 power(__m256 base, unsigned exponent) {
    if (exponent == 32) {  // a faster case for the exponent of the default style
        base = _mm256_mul_ps(base, base);
        base = _mm256_mul_ps(base, base);
        base = _mm256_mul_ps(base, base);
        base = _mm256_mul_ps(base, base);
        return _mm256_mul_ps(base, base);
    }
    __m256 result = _mm256_set1_ps(1);
    for (; exponent > 1; exponent >>= 1) {
        if ((exponent & 1) != 0) result = _mm256_mul_ps(result, base);
        base = _mm256_mul_ps(base, base);
    }
    return _mm256_mul_ps(result, base);
}

/// Returns one channel of eight RGBA pixels, as numbers from 0 to 255. `channel` is 0 … 3 for R, G, B, A.
template <int channel>
OVAL4D_AVX2 inline __m256 channelOf(__m256i pixels) {
    return _mm256_cvtepi32_ps(_mm256_and_si256(_mm256_srli_epi32(pixels, 8 * channel), _mm256_set1_epi32(255)));
}

/// Transposes a matrix of 8 × 8 numbers in place.
OVAL4D_AVX2 inline void transpose(__m256 (&rows)[8]) {
    __m256 a[8], b[8];
    for (std::size_t i = 0; i < 8; i += 2) {
        a[i] = _mm256_unpacklo_ps(rows[i], rows[i + 1]);
        a[i + 1] = _mm256_unpackhi_ps(rows[i], rows[i + 1]);
    }
    for (std::size_t i = 0; i < 8; i += 4) {
        for (std::size_t k = 0; k < 2; ++k) {
            b[i + 2 * k] = _mm256_shuffle_ps(a[i + k], a[i + k + 2], 0x44);
            b[i + 2 * k + 1] = _mm256_shuffle_ps(a[i + k], a[i + k + 2], 0xee);
        }
    }
    for (std::size_t i = 0; i < 4; ++i) {
        rows[i] = _mm256_permute2f128_ps(b[i], b[i + 4], 0x20);
        rows[i + 4] = _mm256_permute2f128_ps(b[i], b[i + 4], 0x31);
    }
}

}  // namespace oval4d::render

#endif
