#include "render/slices/patch_drawing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "render/slices/depth_buffer.hpp"

namespace oval4d::render {

#if defined(__x86_64__)

namespace {

// A quad counts as a parallelogram if its fourth corner is at most this many pixels, in x and in y, away from the
// fourth corner of the parallelogram with the same first three corners. Other quads are drawn as two triangles.
constexpr float kMaxSkew = 0.2F;
constexpr int kLanes = PatchCanvas::kLanes;

using Form = Patch::Form;
using DepthUse = ShapeRasterizer::DepthUse;

/// A quantity that is linear in the picture. `origin` is its value at the center of the pixel (0, 0). `x` and `y` are
/// its differences to the next pixels to the right and above.
struct LinearFunction {
    float origin = 0, x = 0, y = 0;
};

/// The properties that all pixels of a patch (a flat polygon) have in common.
struct PatchShading {
    /// `u`, `v` and `halfRadius` are the three components of ShapeVertex::place. `nearness` is PatchCorner::nearness.
    LinearFunction u{}, v{}, halfRadius{}, nearness{};
    glm::vec3 diffuse, specular;  ///< the same as in ShapeVertex
    glm::vec3 color;              ///< R, G and B, 0 … 255
    std::uint32_t alpha;          ///< the opacity of the patch, 0 … 255
    float bulge;                  ///< the radius of the shape, divided by its distance from the eye
};

// Returns the numbers of the eight lanes: 0 … 7.
OVAL4D_AVX2 inline __m256i laneIndices() { return _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7); }

// Returns a mask for eight neighboring pixels of a row, the first of which is in column `at`. In the mask, all bits of
// a pixel are set if its column is in begin … end − 1.
OVAL4D_AVX2 inline __m256i columnRangeMask(int begin, int end, int at) {
    const __m256i x = _mm256_add_epi32(_mm256_set1_epi32(at), laneIndices());
    return _mm256_andnot_si256(_mm256_cmpgt_epi32(_mm256_set1_epi32(begin), x),
                               _mm256_cmpgt_epi32(_mm256_set1_epi32(end), x));
}

// Returns a register with `first` in lanes 0 … 3, and `second` in lanes 4 … 7.
OVAL4D_AVX2 inline __m256i setHalves(int first, int second) {
    return _mm256_set_m128i(_mm_set1_epi32(second), _mm_set1_epi32(first));
}

// Returns the parts of eight pixels that solid shapes leave uncovered, from 0 to 1. `depths` has the values of the
// pixels in the depth buffer.
OVAL4D_AVX2 inline __m256 uncoveredFractions(__m256 depths) {
    const __m256i mask = _mm256_set1_epi32(kCoverageBits);
    const __m256i bits = _mm256_andnot_si256(_mm256_castps_si256(depths), mask);
    return _mm256_mul_ps(_mm256_cvtepi32_ps(bits), _mm256_set1_ps(1.0F / kCoverageBits));
}

// Returns the values of the depth buffer for eight pixels, from the nearnesses of the pixels and their uncovered parts
// (from 0 to 1).
OVAL4D_AVX2 inline __m256 packDepths(__m256 nearness, __m256 uncovered) {
    const __m256i mask = _mm256_set1_epi32(kCoverageBits);
    const __m256i bits =
        _mm256_sub_epi32(mask, _mm256_cvtps_epi32(_mm256_mul_ps(uncovered, _mm256_set1_ps(kCoverageBits))));
    return _mm256_castsi256_ps(_mm256_or_si256(_mm256_andnot_si256(mask, _mm256_castps_si256(nearness)), bits));
}

/// The values of the linear functions of a PatchShading at the first pixels of two rows. Lanes 0 … 3 have the values in
/// the first row, and lanes 4 … 7 those in the second row.
struct RowStartValues {
    __m256 u, v, halfRadius, nearness;
};

// Returns the values of the linear functions of `paint` at the pixels (x1, y1) and (x2, y2). Returns 0 for functions
// that a patch of this form does not need.
template <Form form, DepthUse depth>
OVAL4D_AVX2 inline RowStartValues startValues(const PatchShading& paint, int x1, int y1, int x2, int y2) {
    const auto of = [&](const LinearFunction& f) OVAL4D_AVX2 {
        const auto at = [&](int x, int y) {
            return f.origin + f.y * static_cast<float>(y) + f.x * static_cast<float>(x);
        };
        return _mm256_set_m128(_mm_set1_ps(at(x2, y2)), _mm_set1_ps(at(x1, y1)));
    };
    constexpr bool isRound = form == Form::strip || form == Form::disk;
    RowStartValues values;
    values.u = isRound ? of(paint.u) : _mm256_setzero_ps();
    values.v = form == Form::disk ? of(paint.v) : _mm256_setzero_ps();
    values.halfRadius = form == Form::rim ? of(paint.halfRadius) : _mm256_setzero_ps();
    values.nearness = depth == DepthUse::unused ? _mm256_setzero_ps() : of(paint.nearness);
    return values;
}

/// Eight neighboring pixels of a row.
struct PixelsOfOneRow {
    std::ptrdiff_t index;  ///< the index in the picture of the first of the eight pixels

    OVAL4D_AVX2 __m256 loadDepths(const float* nearness) const { return _mm256_loadu_ps(nearness + index); }
    OVAL4D_AVX2 void setDepths(float* nearness, __m256 depths) const { _mm256_storeu_ps(nearness + index, depths); }
    OVAL4D_AVX2 __m256i loadColors(const std::uint32_t* pixels) const {
        return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(pixels + index));
    }
    OVAL4D_AVX2 void setColors(std::uint32_t* pixels, __m256i colors) const {
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(pixels + index), colors);
    }
};

/// Four neighboring pixels of a row, and four of another row.
struct PixelsOfTwoRows {
    std::ptrdiff_t first, second;  ///< the indices in the picture of the first pixel in each of the two rows

    OVAL4D_AVX2 __m256 loadDepths(const float* nearness) const {
        return _mm256_set_m128(_mm_loadu_ps(nearness + second), _mm_loadu_ps(nearness + first));
    }
    OVAL4D_AVX2 void setDepths(float* nearness, __m256 depths) const {
        _mm_storeu_ps(nearness + first, _mm256_castps256_ps128(depths));
        _mm_storeu_ps(nearness + second, _mm256_extractf128_ps(depths, 1));
    }
    OVAL4D_AVX2 __m256i loadColors(const std::uint32_t* pixels) const {
        return _mm256_set_m128i(_mm_loadu_si128(reinterpret_cast<const __m128i*>(pixels + second)),
                                _mm_loadu_si128(reinterpret_cast<const __m128i*>(pixels + first)));
    }
    OVAL4D_AVX2 void setColors(std::uint32_t* pixels, __m256i colors) const {
        _mm_storeu_si128(reinterpret_cast<__m128i*>(pixels + first), _mm256_castsi256_si128(colors));
        _mm_storeu_si128(reinterpret_cast<__m128i*>(pixels + second), _mm256_extracti128_si256(colors, 1));
    }
};

// Draws eight pixels of a patch (a flat polygon). `start` has the values at the first pixel of each row, and `offsets`
// says how many columns each of the eight pixels is to the right of the first pixel of its row. In `inside`, all bits
// of a pixel are set if the pixel is in the patch. The formulas are those of the fragment shader in shape_batch.cpp.
template <Form form, DepthUse depth, typename Pixels>
OVAL4D_AVX2 inline void fillPixels(const PatchCanvas& canvas, const PatchShading& paint, const Pixels& pixels,
                                   const RowStartValues& start, __m256i offsets, __m256 inside) {
    constexpr bool isRound = form == Form::strip || form == Form::disk;
    const __m256 zero = _mm256_setzero_ps(), one = _mm256_set1_ps(1), most = _mm256_set1_ps(255);
    const __m256 offset = _mm256_cvtepi32_ps(offsets);
    const auto valueOf = [&](const LinearFunction& f, const __m256& first)
                             OVAL4D_AVX2 { return _mm256_add_ps(first, _mm256_mul_ps(offset, _mm256_set1_ps(f.x))); };

    // n is the component of the normal (u, v, n) toward the eye, and q = 1 − u² − v².
    __m256 u = zero, v = zero, q = one;
    if constexpr (isRound) {
        u = valueOf(paint.u, start.u);
        q = _mm256_fnmadd_ps(u, u, q);
    }
    if constexpr (form == Form::disk) {
        v = valueOf(paint.v, start.v);
        q = _mm256_fnmadd_ps(v, v, q);
    }
    const __m256 n = isRound ? _mm256_sqrt_ps(_mm256_max_ps(q, zero)) : one;
    __m256 alpha = _mm256_set1_ps(static_cast<float>(paint.alpha) / 255);
    if constexpr (form != Form::face) {
        const __m256 thickness =
            form == Form::rim ? valueOf(paint.halfRadius, start.halfRadius) : _mm256_set1_ps(paint.halfRadius.origin);
        const __m256 covered = _mm256_fmadd_ps(q, thickness, _mm256_set1_ps(0.5F));
        alpha = _mm256_mul_ps(alpha, _mm256_max_ps(_mm256_min_ps(covered, one), zero));
    }
    if constexpr (depth == DepthUse::unused) {
        alpha = _mm256_and_ps(alpha, inside);
    } else {
        // Let d be the distance of the patch from the eye, r the much smaller radius of the shape, and n the component
        // of the normal toward the eye. The point of the shape is closer to the eye than the patch by r·n. So its
        // nearness is 1 / (d − r·n), which is almost (1 + n·r/d) / d. Here, 1/d is `patch`, and r/d is paint.bulge.
        const __m256 patch = valueOf(paint.nearness, start.nearness);
        const __m256 nearness = _mm256_fmadd_ps(_mm256_mul_ps(patch, _mm256_set1_ps(paint.bulge)), n, patch);
        const __m256 old = pixels.loadDepths(canvas.nearness), isNearer = _mm256_cmp_ps(nearness, old, _CMP_GT_OQ);
        const __m256 uncovered = uncoveredFractions(old), rest = _mm256_fnmadd_ps(alpha, uncovered, uncovered);
        alpha = _mm256_mul_ps(alpha, _mm256_blendv_ps(uncovered, one, isNearer));
        inside = _mm256_and_ps(inside, _mm256_cmp_ps(alpha, zero, _CMP_GT_OQ));
        if (_mm256_testz_ps(inside, inside) != 0) return;
        alpha = _mm256_and_ps(alpha, inside);
        if constexpr (depth == DepthUse::written) {
            const __m256 written = packDepths(_mm256_max_ps(nearness, old), rest);
            pixels.setDepths(canvas.nearness, _mm256_blendv_ps(old, written, inside));
        }
    }

    const auto product = [&](const glm::vec3& direction) OVAL4D_AVX2 {
        __m256 sum = _mm256_mul_ps(n, _mm256_set1_ps(direction.z));
        if constexpr (isRound) sum = _mm256_fmadd_ps(u, _mm256_set1_ps(direction.x), sum);
        if constexpr (form == Form::disk) sum = _mm256_fmadd_ps(v, _mm256_set1_ps(direction.y), sum);
        return _mm256_max_ps(sum, zero);
    };
    const __m256 light = _mm256_add_ps(_mm256_set1_ps(canvas.ambient), product(paint.diffuse));
    __m256 shine = zero;
    if constexpr (isRound)
        shine = _mm256_mul_ps(power(product(paint.specular), canvas.shininess), _mm256_set1_ps(canvas.gloss));
    const __m256 kept = _mm256_sub_ps(one, alpha);
    const __m256i old = pixels.loadColors(canvas.pixels);
    const auto over = [&](const __m256& above, const __m256& below) OVAL4D_AVX2 {
        return _mm256_cvtps_epi32(_mm256_fmadd_ps(above, alpha, _mm256_mul_ps(below, kept)));
    };
    const auto blend = [&](float channel, const __m256& below) OVAL4D_AVX2 {
        return over(_mm256_min_ps(_mm256_fmadd_ps(_mm256_set1_ps(channel), light, shine), most), below);
    };
    const __m256i red = blend(paint.color.r, channelOf<0>(old)), green = blend(paint.color.g, channelOf<1>(old));
    const __m256i blue = blend(paint.color.b, channelOf<2>(old));
    const __m256i opacity = canvas.opaque ? _mm256_set1_epi32(255) : over(most, channelOf<3>(old));
    pixels.setColors(canvas.pixels,
                     _mm256_or_si256(_mm256_or_si256(red, _mm256_slli_epi32(green, 8)),
                                     _mm256_or_si256(_mm256_slli_epi32(blue, 16), _mm256_slli_epi32(opacity, 24))));
}

// Draws a patch (a flat polygon). Draws two rows at a time if both have at most four pixels of the patch, as do most
// rows of thin bars; otherwise draws one row at a time.
template <Form form, DepthUse depth>
OVAL4D_AVX2 void fillPatch(const PatchCanvas& canvas, const RowRange& rows, const PatchShading& paint) {
    constexpr int kHalf = kLanes / 2;
    const __m256i inHalf = _mm256_setr_epi32(0, 1, 2, 3, 0, 1, 2, 3);
    const auto isNarrow = [&](int y) { return canvas.right[y] - canvas.left[y] <= kHalf; };
    for (int y = rows.begin; y < rows.end; ++y) {
        const int left = canvas.left[y], right = canvas.right[y];
        const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(y) * canvas.width;
        if (isNarrow(y) && y + 1 < rows.end && isNarrow(y + 1)) {
            const int leftAbove = canvas.left[y + 1], rightAbove = canvas.right[y + 1];
            const int at = std::min(left, canvas.width - kHalf), atAbove = std::min(leftAbove, canvas.width - kHalf);
            const __m256i x = _mm256_add_epi32(setHalves(at, atAbove), inHalf);
            const __m256i inside = _mm256_andnot_si256(_mm256_cmpgt_epi32(setHalves(left, leftAbove), x),
                                                       _mm256_cmpgt_epi32(setHalves(right, rightAbove), x));
            fillPixels<form, depth>(canvas, paint, PixelsOfTwoRows{row + at, row + canvas.width + atAbove},
                                    startValues<form, depth>(paint, at, y, atAbove, y + 1), inHalf,
                                    _mm256_castsi256_ps(inside));
            ++y;
            continue;
        }
        for (int x = left; x < right; x += kLanes) {
            const int at = std::min(x, canvas.width - kLanes);
            fillPixels<form, depth>(canvas, paint, PixelsOfOneRow{row + at},
                                    startValues<form, depth>(paint, at, y, at, y), laneIndices(),
                                    _mm256_castsi256_ps(columnRangeMask(x, right, at)));
        }
    }
}

// Blends a face with the picture, without writing depths. All pixels of a face have the same color, so integers
// suffice: the result is (255 − α) · pixel + α · color, divided by 255 and rounded exactly. α is from 0 to 255. With
// `tested`, fillPixels() draws each group of eight pixels in which a solid shape is nearer than the face at one pixel
// at least. Most groups have no such pixel.
template <DepthUse depth>
OVAL4D_AVX2 void fillFace(const PatchCanvas& canvas, const RowRange& rows, const PatchShading& paint) {
    static_assert(depth != DepthUse::written);
    const float light = canvas.ambient + paint.diffuse.z, alpha = static_cast<float>(paint.alpha);
    const auto term = [&](float channel) {
        return static_cast<std::uint64_t>(std::lround(std::min(channel * light, 255.0F) * alpha));
    };
    const std::uint64_t terms = term(paint.color.r) | term(paint.color.g) << 16 | term(paint.color.b) << 32 |
                                std::uint64_t{255} * paint.alpha << 48;
    const __m256i added = _mm256_set1_epi64x(static_cast<std::int64_t>(terms));
    const __m256i kept = _mm256_set1_epi16(static_cast<short>(255 - paint.alpha)), zero = _mm256_setzero_si256();
    const __m256i rounder = _mm256_set1_epi16(128);
    for (int y = rows.begin; y < rows.end; ++y) {
        const int end = canvas.right[y];
        for (int x = canvas.left[y]; x < end; x += kLanes) {
            const int at = std::min(x, canvas.width - kLanes);
            const PixelsOfOneRow pixels{static_cast<std::ptrdiff_t>(y) * canvas.width + at};
            const __m256i inside = columnRangeMask(x, end, at);
            if constexpr (depth == DepthUse::tested) {
                const auto start = startValues<Form::face, depth>(paint, at, y, at, y);
                const __m256 column = _mm256_cvtepi32_ps(laneIndices()), bulge = _mm256_set1_ps(paint.bulge);
                const __m256 patch = _mm256_fmadd_ps(column, _mm256_set1_ps(paint.nearness.x), start.nearness);
                const __m256 nearness = _mm256_fmadd_ps(patch, bulge, patch),
                             solid = pixels.loadDepths(canvas.nearness);
                const __m256i coverage = _mm256_and_si256(_mm256_castps_si256(solid), _mm256_set1_epi32(kCoverageBits));
                const __m256 isVisible = _mm256_or_ps(_mm256_cmp_ps(nearness, solid, _CMP_GT_OQ),
                                                      _mm256_castsi256_ps(_mm256_cmpeq_epi32(coverage, zero)));
                // If a solid shape is nearer at one of these pixels at least, fillPixels() draws all of them.
                if (_mm256_testc_ps(isVisible, _mm256_castsi256_ps(inside)) == 0) {
                    fillPixels<Form::face, depth>(canvas, paint, pixels, start, laneIndices(),
                                                  _mm256_castsi256_ps(inside));
                    continue;
                }
            }
            const __m256i old = pixels.loadColors(canvas.pixels);
            __m256i low = _mm256_unpacklo_epi8(old, zero), high = _mm256_unpackhi_epi8(old, zero);
            low = _mm256_add_epi16(_mm256_add_epi16(_mm256_mullo_epi16(low, kept), added), rounder);
            high = _mm256_add_epi16(_mm256_add_epi16(_mm256_mullo_epi16(high, kept), added), rounder);
            low = _mm256_srli_epi16(_mm256_add_epi16(low, _mm256_srli_epi16(low, 8)), 8);
            high = _mm256_srli_epi16(_mm256_add_epi16(high, _mm256_srli_epi16(high, 8)), 8);
            pixels.setColors(canvas.pixels, _mm256_blendv_epi8(old, _mm256_packus_epi16(low, high), inside));
        }
    }
}

// Returns the first row of `rows` whose center is not below y, or rows.end if there is no such row.
OVAL4D_AVX2 inline int firstRow(float y, const RowRange& rows) {
    const auto begin = static_cast<float>(rows.begin), end = static_cast<float>(rows.end);
    return static_cast<int>(std::ceil(std::min(end, std::max(begin, y - 0.5F))));  // if y is NaN, the result is `begin`
}

// Finds the pixels whose centers are in a convex polygon. Returns the rows of these pixels, and sets the entries of
// canvas.left and canvas.right for these rows. Polygons with a common edge have no common pixels and leave no gap,
// because the pixels at an edge depend only on the ends of the edge.
OVAL4D_AVX2 RowRange findCoveredRows(const PatchCanvas& canvas, std::span<const PatchCorner> corners,
                                     bool counterclockwise) {
    RowRange rows{corners[0].row, corners[0].row};
    for (const PatchCorner& corner : corners) rows = {std::min(rows.begin, corner.row), std::max(rows.end, corner.row)};
    const __m256i mostLeft = _mm256_setzero_si256(), mostRight = _mm256_set1_epi32(canvas.width);
    for (int y = rows.begin; y < rows.end; y += kLanes) {
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(canvas.left + y), mostRight);
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(canvas.right + y), mostLeft);
    }
    const __m256 zero = _mm256_setzero_ps(), width = _mm256_cvtepi32_ps(mostRight);
    const PatchCorner* a = &corners.back();
    for (const PatchCorner& b : corners) {
        const bool up = a->y < b.y, isRight = up == counterclockwise;
        const PatchCorner &from = up ? *a : b, &to = up ? b : *a;
        a = &b;
        if (from.row >= to.row) continue;
        const float slope = (to.x - from.x) / (to.y - from.y);
        const __m256 slopes = _mm256_set1_ps(slope);
        const __m256 start = _mm256_set1_ps(from.x - 0.5F + slope * (0.5F - from.y));
        for (int y = from.row; y < to.row; y += kLanes) {
            const __m256i row = _mm256_add_epi32(_mm256_set1_epi32(y), laneIndices());
            const __m256 x = _mm256_ceil_ps(_mm256_fmadd_ps(_mm256_cvtepi32_ps(row), slopes, start));
            const __m256i pixel = _mm256_cvttps_epi32(_mm256_min_ps(_mm256_max_ps(x, zero), width));
            auto* const bounds = reinterpret_cast<__m256i*>((isRight ? canvas.right : canvas.left) + y);
            const __m256i old = _mm256_loadu_si256(bounds);
            const __m256i bound = isRight ? _mm256_max_epi32(old, pixel) : _mm256_min_epi32(old, pixel);
            _mm256_storeu_si256(bounds,
                                _mm256_blendv_epi8(old, bound, _mm256_cmpgt_epi32(_mm256_set1_epi32(to.row), row)));
        }
    }
    return rows;
}

// Returns the nearness of a face as a linear function. The gradient of the function is the mean of the gradients in the
// triangles of a fan that divides the face, weighted by the areas of the triangles. `area` is twice the signed area of
// the polygon.
OVAL4D_AVX2 LinearFunction nearnessPlaneOf(std::span<const PatchCorner> corners, float area) {
    const PatchCorner& first = corners[0];
    float x = 0, y = 0, sumX = first.x, sumY = first.y, sum = first.nearness;
    for (std::size_t i = 1; i < corners.size(); ++i) {
        const PatchCorner& c = corners[i];
        sumX += c.x;
        sumY += c.y;
        sum += c.nearness;
        const PatchCorner& b = corners[i - 1];
        const float stepB = b.nearness - first.nearness, stepC = c.nearness - first.nearness;
        x += stepB * (c.y - first.y) - stepC * (b.y - first.y);
        y += stepC * (b.x - first.x) - stepB * (c.x - first.x);
    }
    x /= area;
    y /= area;
    return {(sum - x * sumX - y * sumY) / static_cast<float>(corners.size()) + 0.5F * (x + y), x, y};
}

template <Form form>
OVAL4D_AVX2 void fillPatchWithDepthUse(const PatchCanvas& canvas, const RowRange& rows, const PatchShading& paint,
                                       DepthUse depth) {
    if (depth == DepthUse::unused) return fillPatch<form, DepthUse::unused>(canvas, rows, paint);
    if (depth == DepthUse::tested) return fillPatch<form, DepthUse::tested>(canvas, rows, paint);
    fillPatch<form, DepthUse::written>(canvas, rows, paint);
}

OVAL4D_AVX2 PatchShading shadingOf(const ShapeVertex& look, float pixelSize) {
    PatchShading paint{.diffuse = look.diffuse,
                       .specular = look.specular,
                       .color = {look.color & 255, look.color >> 8 & 255, look.color >> 16 & 255},
                       .alpha = look.color >> 24,
                       .bulge = 2 * look.place.z * pixelSize};
    paint.halfRadius.origin = look.place.z;
    return paint;
}

OVAL4D_AVX2 void drawFace(const PatchCanvas& canvas, std::span<const PatchCorner> corners, const ShapeVertex& look,
                          DepthUse depth, float pixelSize) {
    const PatchCorner& first = corners[0];
    float area = 0;
    for (std::size_t i = 2; i < corners.size(); ++i) {
        const PatchCorner &b = corners[i - 1], &c = corners[i];
        area += (b.x - first.x) * (c.y - first.y) - (c.x - first.x) * (b.y - first.y);
    }
    if (area == 0) return;
    const RowRange rows = findCoveredRows(canvas, corners, area > 0);
    if (rows.begin >= rows.end) return;
    PatchShading paint = shadingOf(look, pixelSize);
    if (depth == DepthUse::unused) return fillFace<DepthUse::unused>(canvas, rows, paint);
    paint.nearness = nearnessPlaneOf(corners, area);
    if (depth == DepthUse::tested) return fillFace<DepthUse::tested>(canvas, rows, paint);
    paint.bulge = 0;
    fillPatch<Form::face, DepthUse::written>(canvas, rows, paint);
}

// Draws a patch (a flat polygon) of any form except Form::face. The patch must be a triangle, or a parallelogram to
// within kMaxSkew pixels. So ShapeVertex::place and the nearness count as linear functions of the position in the
// picture.
OVAL4D_AVX2 void drawQuad(const PatchCanvas& canvas, std::span<const PatchCorner> corners, const ShapeVertex& look,
                          Form form, DepthUse depth, float pixelSize) {
    // The gradient of a quantity is computed from its differences along the diagonals of the quad. A triangle counts as
    // a quad whose fourth corner is equal to the first.
    const PatchCorner &a = corners[0], &b = corners[1], &c = corners[2], &d = corners.size() == 4 ? corners[3] : a;
    const float x1 = c.x - a.x, y1 = c.y - a.y, x2 = d.x - b.x, y2 = d.y - b.y;
    const float area = x1 * y2 - x2 * y1;
    if (area == 0) return;
    const RowRange rows = findCoveredRows(canvas, corners, area > 0);
    if (rows.begin >= rows.end) return;
    const float inverse = 1 / area, middleX = 0.25F * (a.x + b.x + c.x + d.x) - 0.5F,
                middleY = 0.25F * (a.y + b.y + c.y + d.y) - 0.5F;
    const auto functionOf = [&](float atA, float atB, float atC, float atD) OVAL4D_AVX2 {
        const float first = atC - atA, second = atD - atB;
        const float x = (first * y2 - second * y1) * inverse, y = (second * x1 - first * x2) * inverse;
        return LinearFunction{0.25F * (atA + atB + atC + atD) - x * middleX - y * middleY, x, y};
    };
    PatchShading paint = shadingOf(look, pixelSize);
    if (depth != DepthUse::unused) paint.nearness = functionOf(a.nearness, b.nearness, c.nearness, d.nearness);
    if (form == Form::rim) {
        paint.halfRadius = functionOf(a.place.z, b.place.z, c.place.z, d.place.z);
        return fillPatchWithDepthUse<Form::rim>(canvas, rows, paint, depth);
    }
    paint.u = functionOf(a.place.x, b.place.x, c.place.x, d.place.x);
    if (form == Form::strip) return fillPatchWithDepthUse<Form::strip>(canvas, rows, paint, depth);
    paint.v = functionOf(a.place.y, b.place.y, c.place.y, d.place.y);
    fillPatchWithDepthUse<Form::disk>(canvas, rows, paint, depth);
}

}  // namespace

OVAL4D_AVX2 void drawPatch(const PatchCanvas& canvas, std::span<const ShapeVertex> vertices,
                           std::span<PatchCorner> corners, Patch::Form form, ShapeRasterizer::DepthUse depth,
                           float pixelSize) {
    const float halfWidth = 0.5F * static_cast<float>(canvas.width),
                halfHeight = 0.5F * static_cast<float>(canvas.height);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const glm::vec3& at = vertices[i].clip;
        const float nearness = 1 / at.z, y = (at.y * nearness + 1) * halfHeight;
        corners[i] = {(at.x * nearness + 1) * halfWidth, y, nearness, firstRow(y, canvas.rows), vertices[i].place};
    }
    if (form == Form::face) return drawFace(canvas, corners, vertices[0], depth, pixelSize);
    const auto isParallelogram = [&]() OVAL4D_AVX2 {
        const float skewX = corners[0].x - corners[1].x + corners[2].x - corners[3].x;
        const float skewY = corners[0].y - corners[1].y + corners[2].y - corners[3].y;
        return std::max(std::abs(skewX), std::abs(skewY)) <= kMaxSkew;
    };
    if (corners.size() == 3 || (corners.size() == 4 && isParallelogram()))
        return drawQuad(canvas, corners, vertices[0], form, depth, pixelSize);
    for (std::size_t i = 2; i < corners.size(); ++i)
        drawQuad(canvas, std::array{corners[0], corners[i - 1], corners[i]}, vertices[0], form, depth, pixelSize);
}

#endif

}  // namespace oval4d::render
