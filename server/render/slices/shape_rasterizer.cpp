#include "render/slices/shape_rasterizer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include <glm/common.hpp>
#include <glm/vec2.hpp>

#include "render/color.hpp"
#include "render/slices/avx2.hpp"
#include "render/slices/depth_buffer.hpp"

namespace oval4d::render {

#if defined(__x86_64__)

namespace {

// Patches are cut off at this distance from the eye, in view coordinates.
constexpr float kNearest = 1e-3F;
// The coordinates of a quad's corners may deviate by this many pixels from those of a parallelogram. A quad that
// deviates more is drawn as two triangles.
constexpr float kMaxSkew = 0.2F;
constexpr int kLanes = 8;

using Form = Patch::Form;
using Depth = ShapeRasterizer::Depth;

/// A vertex of a patch in the picture.
struct Corner {
    float x, y;      ///< in pixels from the lower left corner
    float nearness;  ///< 1 / (the distance from the eye along the view axis)
    int row;         ///< the first of the drawn rows whose center is not below the corner, or their end
    glm::vec3 place;
};

/// A quantity that is linear in the picture: its value at the center of pixel (0, 0), and its differences to the next
/// pixels to the right and above.
struct Plane {
    float origin = 0, x = 0, y = 0;
};

/// The properties that all pixels of a patch share.
struct Paint {
    Plane u{}, v{}, half{}, nearness{};  ///< `half`: ShapeVertex::place.z
    glm::vec3 diffuse, specular;
    glm::vec3 color;      ///< 0 … 255
    std::uint32_t alpha;  ///< 0 … 255
    float bulge;          ///< the radius of the shape, relative to its distance from the eye
};

/// The rows that a patch covers: begin … end − 1.
struct Rows {
    int begin, end;
};

/// The picture to which patches are drawn, the rows that are drawn, and the light.
struct Canvas {
    int width = 0, height = 0;
    Rows rows{0, 0};  ///< those that are drawn
    std::uint32_t* pixels = nullptr;
    float* nearness = nullptr;  ///< the depth buffer
    /// In row y, the current patch covers the pixels left[y] … right[y] − 1. The arrays have kLanes more entries than
    /// there are rows, because rows are computed kLanes at a time.
    int *left = nullptr, *right = nullptr;
    float ambient = 0, gloss = 0;
    unsigned shininess = 1;
    bool opaque = true;  ///< whether the background is, and with it every pixel
};

// Cuts off the part of a convex polygon that is behind the eye or too close to it.
void clip(std::span<const ShapeVertex> vertices, std::vector<ShapeVertex>& out) {
    out.clear();
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const ShapeVertex &a = vertices[i], &b = vertices[(i + 1) % vertices.size()];
        const bool keepA = a.clip.z >= kNearest, keepB = b.clip.z >= kNearest;
        if (keepA) out.push_back(a);
        if (keepA == keepB) continue;
        const float t = (kNearest - a.clip.z) / (b.clip.z - a.clip.z);
        out.push_back(a);
        out.back().clip = glm::mix(a.clip, b.clip, t);
        out.back().place = glm::mix(a.place, b.place, t);
    }
}

// The numbers 0 … 7.
OVAL4D_AVX2 inline __m256i lanes() { return _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7); }

// Returns which of the eight pixels from `at` on are among begin … end − 1.
OVAL4D_AVX2 inline __m256i between(int begin, int end, int at) {
    const __m256i x = _mm256_add_epi32(_mm256_set1_epi32(at), lanes());
    return _mm256_andnot_si256(_mm256_cmpgt_epi32(_mm256_set1_epi32(begin), x),
                               _mm256_cmpgt_epi32(_mm256_set1_epi32(end), x));
}

// All pixels of a face get the same color, so bytes suffice: the exact value of (255 − α) · pixel + α · color, divided
// by 255 and rounded.
OVAL4D_AVX2 void fillFace(const Canvas& canvas, const Rows& rows, const Paint& paint) {
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
        std::uint32_t* const row = canvas.pixels + static_cast<std::ptrdiff_t>(y) * canvas.width;
        for (int x = canvas.left[y]; x < end; x += kLanes) {
            const int at = std::min(x, canvas.width - kLanes);
            auto* const place = reinterpret_cast<__m256i*>(row + at);
            const __m256i old = _mm256_loadu_si256(place);
            __m256i low = _mm256_unpacklo_epi8(old, zero), high = _mm256_unpackhi_epi8(old, zero);
            low = _mm256_add_epi16(_mm256_add_epi16(_mm256_mullo_epi16(low, kept), added), rounder);
            high = _mm256_add_epi16(_mm256_add_epi16(_mm256_mullo_epi16(high, kept), added), rounder);
            low = _mm256_srli_epi16(_mm256_add_epi16(low, _mm256_srli_epi16(low, 8)), 8);
            high = _mm256_srli_epi16(_mm256_add_epi16(high, _mm256_srli_epi16(high, 8)), 8);
            _mm256_storeu_si256(place, _mm256_blendv_epi8(old, _mm256_packus_epi16(low, high), between(x, end, at)));
        }
    }
}

// Returns the parts of eight pixels that solid shapes leave uncovered, from 0 to 1.
OVAL4D_AVX2 inline __m256 uncoveredParts(__m256 depths) {
    const __m256i mask = _mm256_set1_epi32(kCoverageBits);
    const __m256i bits = _mm256_andnot_si256(_mm256_castps_si256(depths), mask);
    return _mm256_mul_ps(_mm256_cvtepi32_ps(bits), _mm256_set1_ps(1.0F / kCoverageBits));
}

// Returns the values of the depth buffer for eight pixels of which these parts are uncovered.
OVAL4D_AVX2 inline __m256 withUncoveredParts(__m256 nearness, __m256 uncovered) {
    const __m256i mask = _mm256_set1_epi32(kCoverageBits);
    const __m256i bits =
        _mm256_sub_epi32(mask, _mm256_cvtps_epi32(_mm256_mul_ps(uncovered, _mm256_set1_ps(kCoverageBits))));
    return _mm256_castsi256_ps(_mm256_or_si256(_mm256_andnot_si256(mask, _mm256_castps_si256(nearness)), bits));
}

// See ShapeProgram for the formulas.
template <Form form, Depth depth>
OVAL4D_AVX2 void fillShape(const Canvas& canvas, const Rows& rows, const Paint& paint) {
    constexpr bool isRound = form == Form::strip || form == Form::disk;
    const __m256 zero = _mm256_setzero_ps(), one = _mm256_set1_ps(1), most = _mm256_set1_ps(255);
    const __m256 alphaScale = _mm256_set1_ps(static_cast<float>(paint.alpha) / 255), half = _mm256_set1_ps(0.5F);
    const __m256 lane = _mm256_cvtepi32_ps(lanes());
    const auto along = [&](const Plane& plane) OVAL4D_AVX2 { return _mm256_mul_ps(lane, _mm256_set1_ps(plane.x)); };
    const __m256 alongU = along(paint.u), alongV = along(paint.v), alongHalf = along(paint.half);
    const __m256 alongNearness = along(paint.nearness);
    for (int y = rows.begin; y < rows.end; ++y) {
        const int end = canvas.right[y];
        const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(y) * canvas.width;
        const auto rowOf = [y](const Plane& plane) { return plane.origin + plane.y * static_cast<float>(y); };
        const float rowU = rowOf(paint.u), rowV = rowOf(paint.v), rowHalf = rowOf(paint.half);
        const float rowNearness = rowOf(paint.nearness);
        for (int x = canvas.left[y]; x < end; x += kLanes) {
            const int at = std::min(x, canvas.width - kLanes);
            const auto column = static_cast<float>(at);
            const auto valueOf = [&](float inRow, const Plane& plane, const __m256& rest) OVAL4D_AVX2 {
                return _mm256_add_ps(_mm256_set1_ps(inRow + plane.x * column), rest);
            };
            __m256 inside = _mm256_castsi256_ps(between(x, end, at));

            // The normal (u, v, n), and q = 1 − u² − v².
            __m256 u = zero, v = zero, q = one;
            if constexpr (isRound) {
                u = valueOf(rowU, paint.u, alongU);
                q = _mm256_fnmadd_ps(u, u, q);
            }
            if constexpr (form == Form::disk) {
                v = valueOf(rowV, paint.v, alongV);
                q = _mm256_fnmadd_ps(v, v, q);
            }
            const __m256 n = isRound ? _mm256_sqrt_ps(_mm256_max_ps(q, zero)) : one;
            __m256 alpha = alphaScale;
            if constexpr (form != Form::face) {
                const __m256 thickness =
                    form == Form::rim ? valueOf(rowHalf, paint.half, alongHalf) : _mm256_set1_ps(paint.half.origin);
                const __m256 coverage = _mm256_max_ps(_mm256_min_ps(_mm256_fmadd_ps(q, thickness, half), one), zero);
                alpha = _mm256_mul_ps(alpha, coverage);
            }
            if constexpr (depth == Depth::unused) {
                alpha = _mm256_and_ps(alpha, inside);
            } else {
                // 1 / (d − r n) is almost (1 + r n / d) / d for a distance d and a much smaller radius r.
                const __m256 patch = valueOf(rowNearness, paint.nearness, alongNearness);
                const __m256 nearness = _mm256_fmadd_ps(_mm256_mul_ps(patch, _mm256_set1_ps(paint.bulge)), n, patch);
                float* const place = canvas.nearness + row + at;
                const __m256 old = _mm256_loadu_ps(place), isNearer = _mm256_cmp_ps(nearness, old, _CMP_GT_OQ);
                const __m256 uncovered = uncoveredParts(old), rest = _mm256_fnmadd_ps(alpha, uncovered, uncovered);
                alpha = _mm256_mul_ps(alpha, _mm256_blendv_ps(uncovered, one, isNearer));
                inside = _mm256_and_ps(inside, _mm256_cmp_ps(alpha, zero, _CMP_GT_OQ));
                if (_mm256_testz_ps(inside, inside) != 0) continue;
                alpha = _mm256_and_ps(alpha, inside);
                if constexpr (depth == Depth::written) {
                    const __m256 written = withUncoveredParts(_mm256_max_ps(nearness, old), rest);
                    _mm256_storeu_ps(place, _mm256_blendv_ps(old, written, inside));
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
            auto* const place = reinterpret_cast<__m256i*>(canvas.pixels + row + at);
            const __m256i old = _mm256_loadu_si256(place);
            const auto over = [&](const __m256& above, const __m256& below) OVAL4D_AVX2 {
                return _mm256_cvtps_epi32(_mm256_fmadd_ps(above, alpha, _mm256_mul_ps(below, kept)));
            };
            const auto blend = [&](float channel, const __m256& below) OVAL4D_AVX2 {
                return over(_mm256_min_ps(_mm256_fmadd_ps(_mm256_set1_ps(channel), light, shine), most), below);
            };
            const __m256i red = blend(paint.color.r, channelOf<0>(old)),
                          green = blend(paint.color.g, channelOf<1>(old));
            const __m256i blue = blend(paint.color.b, channelOf<2>(old));
            const __m256i opacity = canvas.opaque ? _mm256_set1_epi32(255) : over(most, channelOf<3>(old));
            _mm256_storeu_si256(
                place, _mm256_or_si256(_mm256_or_si256(red, _mm256_slli_epi32(green, 8)),
                                       _mm256_or_si256(_mm256_slli_epi32(blue, 16), _mm256_slli_epi32(opacity, 24))));
        }
    }
}

// Returns the first of these rows whose center is not below y, or their end.
OVAL4D_AVX2 inline int firstRow(float y, const Rows& rows) {
    const auto begin = static_cast<float>(rows.begin), end = static_cast<float>(rows.end);
    return static_cast<int>(std::ceil(std::min(end, std::max(begin, y - 0.5F))));  // `begin` if y is not a number
}

// Finds the pixels whose centers are in a convex polygon. Polygons with a common edge have no common pixels and leave
// no gap, because the pixels at an edge depend only on its ends.
OVAL4D_AVX2 Rows findRows(const Canvas& canvas, std::span<const Corner> corners, bool counterclockwise) {
    Rows rows{corners[0].row, corners[0].row};
    for (const Corner& corner : corners) rows = {std::min(rows.begin, corner.row), std::max(rows.end, corner.row)};
    const __m256i mostLeft = _mm256_setzero_si256(), mostRight = _mm256_set1_epi32(canvas.width);
    for (int y = rows.begin; y < rows.end; y += kLanes) {
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(canvas.left + y), mostRight);
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(canvas.right + y), mostLeft);
    }
    const __m256 zero = _mm256_setzero_ps(), width = _mm256_cvtepi32_ps(mostRight);
    const Corner* a = &corners.back();
    for (const Corner& b : corners) {
        const bool up = a->y < b.y, isRight = up == counterclockwise;
        const Corner &from = up ? *a : b, &to = up ? b : *a;
        a = &b;
        if (from.row >= to.row) continue;
        const float slope = (to.x - from.x) / (to.y - from.y);
        const __m256 slopes = _mm256_set1_ps(slope);
        const __m256 start = _mm256_set1_ps(from.x - 0.5F + slope * (0.5F - from.y));
        for (int y = from.row; y < to.row; y += kLanes) {
            const __m256i row = _mm256_add_epi32(_mm256_set1_epi32(y), lanes());
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

// Returns the nearness of a face. The gradient is the mean over the triangles of a fan, weighted by area. `area`: twice
// the area of the polygon.
OVAL4D_AVX2 Plane nearnessOf(std::span<const Corner> corners, float area) {
    const Corner& first = corners[0];
    float x = 0, y = 0, sumX = first.x, sumY = first.y, sum = first.nearness;
    for (std::size_t i = 1; i < corners.size(); ++i) {
        const Corner& c = corners[i];
        sumX += c.x;
        sumY += c.y;
        sum += c.nearness;
        const Corner& b = corners[i - 1];
        const float stepB = b.nearness - first.nearness, stepC = c.nearness - first.nearness;
        x += stepB * (c.y - first.y) - stepC * (b.y - first.y);
        y += stepC * (b.x - first.x) - stepB * (c.x - first.x);
    }
    x /= area;
    y /= area;
    return {(sum - x * sumX - y * sumY) / static_cast<float>(corners.size()) + 0.5F * (x + y), x, y};
}

template <Form form>
OVAL4D_AVX2 void fill(const Canvas& canvas, const Rows& rows, const Paint& paint, Depth depth) {
    if (depth == Depth::unused) return fillShape<form, Depth::unused>(canvas, rows, paint);
    if (depth == Depth::tested) return fillShape<form, Depth::tested>(canvas, rows, paint);
    fillShape<form, Depth::written>(canvas, rows, paint);
}

OVAL4D_AVX2 Paint paintOf(const ShapeVertex& look, float pixelSize) {
    Paint paint{.diffuse = look.diffuse,
                .specular = look.specular,
                .color = {look.color & 255, look.color >> 8 & 255, look.color >> 16 & 255},
                .alpha = look.color >> 24,
                .bulge = 2 * look.place.z * pixelSize};
    paint.half.origin = look.place.z;
    return paint;
}

OVAL4D_AVX2 void drawFace(const Canvas& canvas, std::span<const Corner> corners, const ShapeVertex& look, Depth depth,
                          float pixelSize) {
    const Corner& first = corners[0];
    float area = 0;
    for (std::size_t i = 2; i < corners.size(); ++i) {
        const Corner &b = corners[i - 1], &c = corners[i];
        area += (b.x - first.x) * (c.y - first.y) - (c.x - first.x) * (b.y - first.y);
    }
    if (area == 0) return;
    const Rows rows = findRows(canvas, corners, area > 0);
    if (rows.begin >= rows.end) return;
    Paint paint = paintOf(look, pixelSize);
    if (depth == Depth::unused) return fillFace(canvas, rows, paint);
    paint.nearness = nearnessOf(corners, area);
    if (depth == Depth::written) paint.bulge = 0;
    fill<Form::face>(canvas, rows, paint, depth);
}

// Draws a triangle, or a quad that is almost a parallelogram, of a shape other than a face.
OVAL4D_AVX2 void drawQuad(const Canvas& canvas, std::span<const Corner> corners, const ShapeVertex& look, Form form,
                          Depth depth, float pixelSize) {
    // Gradients follow from the differences along the diagonals. A triangle is a quad whose last corner is its first.
    const Corner &a = corners[0], &b = corners[1], &c = corners[2], &d = corners.size() == 4 ? corners[3] : a;
    const float x1 = c.x - a.x, y1 = c.y - a.y, x2 = d.x - b.x, y2 = d.y - b.y;
    const float area = x1 * y2 - x2 * y1;
    if (area == 0) return;
    const Rows rows = findRows(canvas, corners, area > 0);
    if (rows.begin >= rows.end) return;
    const float inverse = 1 / area, middleX = 0.25F * (a.x + b.x + c.x + d.x) - 0.5F,
                middleY = 0.25F * (a.y + b.y + c.y + d.y) - 0.5F;
    const auto planeOf = [&](float atA, float atB, float atC, float atD) OVAL4D_AVX2 {
        const float first = atC - atA, second = atD - atB;
        const float x = (first * y2 - second * y1) * inverse, y = (second * x1 - first * x2) * inverse;
        return Plane{0.25F * (atA + atB + atC + atD) - x * middleX - y * middleY, x, y};
    };
    Paint paint = paintOf(look, pixelSize);
    if (depth != Depth::unused) paint.nearness = planeOf(a.nearness, b.nearness, c.nearness, d.nearness);
    if (form == Form::rim) {
        paint.half = planeOf(a.place.z, b.place.z, c.place.z, d.place.z);
        return fill<Form::rim>(canvas, rows, paint, depth);
    }
    paint.u = planeOf(a.place.x, b.place.x, c.place.x, d.place.x);
    if (form == Form::strip) return fill<Form::strip>(canvas, rows, paint, depth);
    paint.v = planeOf(a.place.y, b.place.y, c.place.y, d.place.y);
    fill<Form::disk>(canvas, rows, paint, depth);
}

// Draws a patch. `corners` is working memory for as many corners.
OVAL4D_AVX2 void drawPatch(const Canvas& canvas, std::span<const ShapeVertex> vertices, std::span<Corner> corners,
                           Form form, Depth depth, float pixelSize) {
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

}  // namespace

struct ShapeRasterizer::Impl {
    /// Patches or triangles to draw.
    struct Layer {
        const ShapeBatch* shapes;  // null for triangles
        std::size_t first, end;
        Depth depth;
        const SurfaceRasterizer* surfaces;         // null for patches
        std::span<const std::uint32_t> triangles;  // indices of their vertices
        SurfaceRasterizer::Blending blending;

        std::span<const Patch> patches() const {
            return shapes == nullptr ? std::span<const Patch>() : shapes->patches().subspan(first, end - first);
        }
    };
    /// Working memory for drawing some of the rows.
    struct Band {
        std::vector<int> left, right;
        std::vector<ShapeVertex> clipped;
        std::vector<Corner> corners;
    };

    int middleRow() const;
    void drawRows(const Rows& rows, Band& band) const;
    void drawPatches(const Canvas& part, const Layer& layer, Band& band) const;

    Canvas canvas;
    std::uint32_t background = 0;
    PixelArea depthArea{{0, 0}, {0, 0}};
    std::vector<Layer> layers;
    std::vector<float> nearness;
    std::array<Band, 2> bands;
};

ShapeRasterizer::ShapeRasterizer() : impl_(std::make_unique<Impl>()) {}

bool ShapeRasterizer::isSupported() {
    return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
}

void ShapeRasterizer::begin(scene::Viewport viewport, const scene::Style& style, std::span<std::uint8_t> pixels) {
    impl_->canvas = {.width = viewport.width,
                     .height = viewport.height,
                     .pixels = reinterpret_cast<std::uint32_t*>(pixels.data()),
                     .ambient = static_cast<float>(style.ambient),
                     .gloss = static_cast<float>(255 * style.specular),
                     .shininess = static_cast<unsigned>(std::lround(style.shininess)),
                     .opaque = style.backgroundOpacity == 1};
    impl_->background = impl_->canvas.opaque ? rgba(style.background, 1) : 0;
    impl_->depthArea = {{0, 0}, {0, 0}};
    impl_->layers.clear();
}

void ShapeRasterizer::add(const ShapeBatch& shapes, std::size_t first, std::size_t end, Depth depth) {
    impl_->layers.push_back({&shapes, first, end, depth, nullptr, {}, {}});
}

void ShapeRasterizer::add(const SurfaceRasterizer& surfaces, std::span<const std::uint32_t> indices,
                          SurfaceRasterizer::Blending blending) {
    impl_->layers.push_back({nullptr, 0, 0, Depth::tested, &surfaces, indices, blending});
}

void ShapeRasterizer::setDepthArea(const PixelArea& area) {
    Impl& m = *impl_;
    const glm::ivec2 size(m.canvas.width, m.canvas.height);
    m.depthArea.from = glm::clamp(area.from, glm::ivec2(0), size);
    m.depthArea.to = glm::clamp(area.to, m.depthArea.from, size);
    m.nearness.resize(static_cast<std::size_t>(m.canvas.width) * static_cast<std::size_t>(m.canvas.height));
    m.canvas.nearness = m.nearness.data();
}

void ShapeRasterizer::finish(parallel::ForkJoin* forkJoin) {
    Impl& m = *impl_;
    const int height = m.canvas.height;
    if (forkJoin == nullptr) return m.drawRows({0, height}, m.bands[0]);
    const int middle = m.middleRow();
    const auto drawLower = [&] { m.drawRows({0, middle}, m.bands[0]); };
    const auto drawUpper = [&] { m.drawRows({middle, height}, m.bands[1]); };
    forkJoin->invoke(std::ref(drawLower), std::ref(drawUpper));
}

// Returns the row above and below which there is about the same to draw.
int ShapeRasterizer::Impl::middleRow() const {
    double sum = 0;  // of heights, from 0 to 1
    std::size_t count = 0;
    for (const Layer& layer : layers) {
        for (const Patch& patch : layer.patches()) {
            if (patch.count == 0) continue;
            const glm::vec3& at = layer.shapes->vertices()[patch.first].clip;
            sum += 0.5 + 0.5 * std::max(-1.0F, std::min(1.0F, at.y / std::max(at.z, kNearest)));
        }
        const std::size_t triangles = layer.triangles.size() / 3;
        if (triangles > 0) sum += layer.surfaces->meanHeight(layer.triangles) * static_cast<double>(triangles);
        count += layer.patches().size() + triangles;
    }
    const double mean = count == 0 ? 0.5 : sum / static_cast<double>(count);
    return static_cast<int>(mean * canvas.height);
}

void ShapeRasterizer::Impl::drawRows(const Rows& rows, Band& band) const {
    for (std::vector<int>* bounds : {&band.left, &band.right})
        bounds->resize(static_cast<std::size_t>(canvas.height) + kLanes);
    Canvas part = canvas;
    part.rows = rows;
    part.left = band.left.data();
    part.right = band.right.data();
    const auto startOf = [&](int y) { return static_cast<std::ptrdiff_t>(y) * canvas.width; };
    std::fill(canvas.pixels + startOf(rows.begin), canvas.pixels + startOf(rows.end), background);
    const auto& [from, to] = depthArea;
    for (int y = std::max(rows.begin, from.y); y < std::min(rows.end, to.y); ++y)
        std::fill(canvas.nearness + startOf(y) + from.x, canvas.nearness + startOf(y) + to.x, 0.0F);
    for (const Layer& layer : layers) {
        if (layer.shapes != nullptr) {
            drawPatches(part, layer, band);
        } else {
            layer.surfaces->draw({canvas.width, canvas.height, rows.begin, rows.end, canvas.pixels, canvas.nearness},
                                 layer.triangles, layer.blending);
        }
    }
}

void ShapeRasterizer::Impl::drawPatches(const Canvas& part, const Layer& layer, Band& band) const {
    const float pixelSize = 1 / layer.shapes->projection().focalLength();
    for (const Patch& patch : layer.patches()) {
        std::span<const ShapeVertex> vertices = layer.shapes->vertices().subspan(patch.first, patch.count);
        if (std::ranges::any_of(vertices, [](const ShapeVertex& v) { return v.clip.z < kNearest; })) {
            clip(vertices, band.clipped);
            vertices = band.clipped;
        }
        if (vertices.size() < 3) continue;
        band.corners.resize(vertices.size());
        drawPatch(part, vertices, band.corners, patch.form, layer.depth, pixelSize);
    }
}

void ShapeRasterizer::freeMemory() { *impl_ = {}; }

#undef OVAL4D_AVX2

#else

struct ShapeRasterizer::Impl {};

ShapeRasterizer::ShapeRasterizer() = default;
bool ShapeRasterizer::isSupported() { return false; }
void ShapeRasterizer::begin(scene::Viewport /*viewport*/, const scene::Style& /*style*/,
                            std::span<std::uint8_t> /*pixels*/) {}
void ShapeRasterizer::add(const ShapeBatch& /*shapes*/, std::size_t /*first*/, std::size_t /*end*/, Depth /*depth*/) {}
void ShapeRasterizer::add(const SurfaceRasterizer& /*surfaces*/, std::span<const std::uint32_t> /*indices*/,
                          SurfaceRasterizer::Blending /*blending*/) {}
void ShapeRasterizer::setDepthArea(const PixelArea& /*area*/) {}
void ShapeRasterizer::finish(parallel::ForkJoin* /*forkJoin*/) {}
void ShapeRasterizer::freeMemory() {}

#endif

ShapeRasterizer::~ShapeRasterizer() = default;

}  // namespace oval4d::render
