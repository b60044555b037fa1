#include "render/slices/surface_rasterizer.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include <glm/geometric.hpp>

#include "render/slices/avx2.hpp"
#include "render/slices/depth_buffer.hpp"

namespace oval4d::render {

#if defined(__x86_64__)

namespace {

using Blending = SurfaceRasterizer::Blending;
using LitVertex = SurfaceRasterizer::LitVertex;

constexpr std::size_t kLanes = 8;
// How many indices ahead corners are loaded into the cache (prefetched). While eight triangles are drawn, the first
// corners of eight later triangles are prefetched, because another core may have written them. The other corners are
// often close to the first corners in memory.
constexpr std::size_t kAhead = 2 * 3 * kLanes;

static_assert(sizeof(LitVertex) == 8 * sizeof(float));
static_assert(sizeof(SurfaceVertex) == 7 * sizeof(float));

// The properties of the picture and of the light that all vertices have in common.
struct Lighting {
    float halfWidth, halfHeight;  // half the size of the picture, in pixels
    float ambient, diffuse;
    float gloss;  // the intensity of specular light, 0 … 255
    unsigned shininess;
    // Unit vectors in view coordinates. `light` points to the light. `halfVector` points halfway between the directions
    // to the light and to the eye.
    glm::vec3 light, halfVector;
};

// Projects and lights eight vertices. A vertex has seven floats, but eight floats are read for each vertex. Therefore
// one more float after the last vertex must be readable.
OVAL4D_AVX2 void projectAndLightEight(const Lighting& lighting, const SurfaceVertex* in, LitVertex* out) {
    __m256 v[kLanes];
    for (std::size_t i = 0; i < kLanes; ++i) v[i] = _mm256_loadu_ps(&in[i].clip.x);
    transpose(v);
    const __m256 &clipX = v[0], &clipY = v[1], &clipW = v[2], &normalX = v[3], &normalY = v[4], &normalZ = v[5];
    const __m256 zero = _mm256_setzero_ps(), one = _mm256_set1_ps(1), most = _mm256_set1_ps(255);

    const __m256 nearness = _mm256_div_ps(one, clipW);
    // All bits of `behind` are set for a vertex that cannot be projected, because it is behind the eye or too close to
    // it. A float with all bits set is NaN.
    const __m256 behind = _mm256_cmp_ps(clipW, _mm256_set1_ps(kNearPlane), _CMP_NGE_UQ);
    const auto pixel = [&](const __m256& clip, float half) OVAL4D_AVX2 {
        const __m256 halves = _mm256_set1_ps(half);
        return _mm256_or_ps(_mm256_fmadd_ps(_mm256_mul_ps(clip, nearness), halves, halves), behind);
    };

    const auto product = [&](const glm::vec3& direction) OVAL4D_AVX2 {
        const __m256 sum =
            _mm256_fmadd_ps(normalY, _mm256_set1_ps(direction.y), _mm256_mul_ps(normalX, _mm256_set1_ps(direction.x)));
        return _mm256_fmadd_ps(normalZ, _mm256_set1_ps(direction.z), sum);
    };
    const __m256 length2 =
        _mm256_fmadd_ps(normalZ, normalZ, _mm256_fmadd_ps(normalY, normalY, _mm256_mul_ps(normalX, normalX)));
    const __m256 scale = _mm256_div_ps(one, _mm256_sqrt_ps(length2));
    const auto cosine = [&](const glm::vec3& direction) OVAL4D_AVX2 {
        return _mm256_max_ps(_mm256_mul_ps(product(direction), scale), zero);  // at least 0; 0 if the normal is 0
    };
    const __m256 light =
        _mm256_fmadd_ps(cosine(lighting.light), _mm256_set1_ps(lighting.diffuse), _mm256_set1_ps(lighting.ambient));
    const __m256 shine =
        _mm256_mul_ps(power(cosine(lighting.halfVector), lighting.shininess), _mm256_set1_ps(lighting.gloss));
    const __m256i bytes = _mm256_castps_si256(v[6]);
    const __m256 alpha = channelOf<3>(bytes), opacity = _mm256_mul_ps(alpha, _mm256_set1_ps(1.0F / 255));
    const auto lit = [&](const __m256& color) OVAL4D_AVX2 {
        return _mm256_mul_ps(_mm256_min_ps(_mm256_fmadd_ps(color, light, shine), most), opacity);
    };
    __m256 rows[kLanes]{nearness,
                        pixel(clipX, lighting.halfWidth),
                        pixel(clipY, lighting.halfHeight),
                        zero,
                        lit(channelOf<0>(bytes)),
                        lit(channelOf<1>(bytes)),
                        lit(channelOf<2>(bytes)),
                        alpha};
    transpose(rows);
    for (std::size_t i = 0; i < kLanes; ++i) _mm256_store_ps(&out[i].nearness, rows[i]);
}

using FloatLanes = std::array<float, kLanes>;
using IntLanes = std::array<std::int32_t, kLanes>;

// The edges and the gradients of eight triangles. The corners p, q and r of each triangle are sorted by height, the
// lowest first.
struct alignas(32) TriangleSetup {
    FloatLanes baseP, baseQ;    // the first row whose center is not below p, and the first whose center is not below q
    IntLanes rowP, rowQ, rowR;  // the first rows whose centers are not below p, q and r, clamped to beginRow … endRow
    // For each edge: its x in the base row of its lower end, minus half a pixel; and the change of x from a row to the
    // next.
    FloatLanes xPQ, xQR, xPR, stepPQ, stepQR, stepPR;
    // Factors from which gradients are computed. If a quantity has the values a, b and c at the corners, in the order
    // of the indices, its derivative d/dx is (b − a) · xB + (c − a) · xC. For d/dy, the factors are yB and yC. The
    // corner with the value a is at (originX, originY), relative to the center of the pixel (0, 0).
    FloatLanes xB, xC, yB, yC, originX, originY;
};

// Exchanges the points (xA, yA) and (xB, yB) in each lane in which the first point is higher.
OVAL4D_AVX2 inline void sortByHeight(__m256& xA, __m256& yA, __m256& xB, __m256& yB) {
    const __m256 isHigher = _mm256_cmp_ps(yA, yB, _CMP_GT_OQ);
    const __m256 x = _mm256_blendv_ps(xA, xB, isHigher), y = _mm256_blendv_ps(yA, yB, isHigher);
    xB = _mm256_blendv_ps(xB, xA, isHigher);
    yB = _mm256_blendv_ps(yB, yA, isHigher);
    xA = x;
    yA = y;
}

// Returns the first column or row of pixels whose center is not before this coordinate.
OVAL4D_AVX2 inline __m256 firstPixel(__m256 coordinate) {
    return _mm256_ceil_ps(_mm256_sub_ps(coordinate, _mm256_set1_ps(0.5F)));
}

// Clamps a number to least … greatest, and truncates it to an integer. Returns `least` if the number is NaN.
OVAL4D_AVX2 inline __m256i clampToInt(__m256 number, float least, float greatest) {
    return _mm256_cvttps_epi32(_mm256_min_ps(_mm256_max_ps(number, _mm256_set1_ps(least)), _mm256_set1_ps(greatest)));
}

// Two masks, each with one bit for each of eight triangles.
struct TriangleMasks {
    unsigned drawn;    // set if the bounding box contains the center of a pixel, and no corner has a position of NaN
    unsigned clipped;  // set if a corner has a position of NaN, because it is behind the eye or too close to it
};

// The indices of the corners of eight triangles. `a` has the first corner of each triangle, `b` the second, and `c` the
// third.
struct TriangleCorners {
    __m256i a, b, c;
};

OVAL4D_AVX2 inline TriangleCorners cornersOf(const std::uint32_t* indices) {
    const auto* const from = reinterpret_cast<const __m256i*>(indices);
    const __m256i first = _mm256_loadu_si256(from), second = _mm256_loadu_si256(from + 1),
                  third = _mm256_loadu_si256(from + 2);
    // The index of corner k of triangle i is entry 3 i + k of the 24 entries. So the index is in lane (3 i + k) mod 8
    // of one of the three registers.
    const auto pick = [&](__m256i x, __m256i y, __m256i z) OVAL4D_AVX2 {
        return _mm256_blend_epi32(_mm256_blend_epi32(x, y, 0b10010010), z, 0b00100100);
    };
    return {_mm256_permutevar8x32_epi32(pick(first, second, third), _mm256_setr_epi32(0, 3, 6, 1, 4, 7, 2, 5)),
            _mm256_permutevar8x32_epi32(pick(third, first, second), _mm256_setr_epi32(1, 4, 7, 2, 5, 0, 3, 6)),
            _mm256_permutevar8x32_epi32(pick(second, third, first), _mm256_setr_epi32(2, 5, 0, 3, 6, 1, 4, 7))};
}

OVAL4D_AVX2 TriangleMasks setUpTriangles(const SurfaceCanvas& canvas, const LitVertex* points,
                                         const std::uint32_t* indices, TriangleSetup& out) {
    const auto& [a, b, c] = cornersOf(indices);
    const auto gather = [points](const float LitVertex::* member, __m256i index) OVAL4D_AVX2 {
        const float* const base = &(points->*member);
        // Each point consists of eight floats.
        return _mm256_i32gather_ps(base, _mm256_slli_epi32(index, 3), 4);
    };
    const __m256 yA = gather(&LitVertex::y, a), yB = gather(&LitVertex::y, b), yC = gather(&LitVertex::y, c);
    const auto begin = static_cast<float>(canvas.beginRow), end = static_cast<float>(canvas.endRow);
    const auto rowOf = [&](const __m256& y) OVAL4D_AVX2 { return clampToInt(firstPixel(y), begin, end); };
    const __m256i rowP = rowOf(_mm256_min_ps(_mm256_min_ps(yA, yB), yC)),
                  rowR = rowOf(_mm256_max_ps(_mm256_max_ps(yA, yB), yC));
    const __m256 sumY = _mm256_add_ps(_mm256_add_ps(yA, yB), yC);
    const __m256 noY = _mm256_cmp_ps(sumY, sumY, _CMP_UNORD_Q);
    const __m256i coversRows = _mm256_cmpgt_epi32(rowR, rowP);
    // Successive triangles are close together. If another thread draws the other rows, often all eight triangles lie
    // outside the rows of this canvas.
    if (_mm256_movemask_ps(_mm256_or_ps(noY, _mm256_castsi256_ps(coversRows))) == 0) return {0, 0};

    const __m256 xA = gather(&LitVertex::x, a), xB = gather(&LitVertex::x, b), xC = gather(&LitVertex::x, c);
    const auto width = static_cast<float>(canvas.width);
    const __m256i left = clampToInt(firstPixel(_mm256_min_ps(_mm256_min_ps(xA, xB), xC)), 0, width),
                  right = clampToInt(firstPixel(_mm256_max_ps(_mm256_max_ps(xA, xB), xC)), 0, width);
    const __m256 sum = _mm256_add_ps(_mm256_add_ps(xA, xB), _mm256_add_ps(xC, sumY));
    const auto isNan = static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(sum, sum, _CMP_UNORD_Q)));
    const __m256i covers = _mm256_and_si256(coversRows, _mm256_cmpgt_epi32(right, left));
    const auto mask = static_cast<unsigned>(_mm256_movemask_ps(_mm256_castsi256_ps(covers)));
    const TriangleMasks masks{mask & ~isNan, isNan};
    if (masks.drawn == 0) return masks;

    __m256 xP = xA, yP = yA, xQ = xB, yQ = yB, xR = xC, yR = yC;
    sortByHeight(xP, yP, xQ, yQ);
    sortByHeight(xQ, yQ, xR, yR);
    sortByHeight(xP, yP, xQ, yQ);
    const __m256 baseP = firstPixel(yP), baseQ = firstPixel(yQ);
    const __m256i rowQ = clampToInt(baseQ, begin, end);
    const auto putNumbers = [&](IntLanes& to, __m256i from)
                                OVAL4D_AVX2 { _mm256_store_si256(reinterpret_cast<__m256i*>(to.data()), from); };
    const auto put = [&](FloatLanes& to, __m256 from) OVAL4D_AVX2 { _mm256_store_ps(to.data(), from); };
    putNumbers(out.rowP, rowP);
    putNumbers(out.rowQ, rowQ);
    putNumbers(out.rowR, rowR);
    put(out.baseP, baseP);
    put(out.baseQ, baseQ);
    const __m256 half = _mm256_set1_ps(0.5F);
    const auto putEdge = [&](const __m256& x0, const __m256& y0, const __m256& x1, const __m256& y1, const __m256& base,
                             FloatLanes& at, FloatLanes& step) OVAL4D_AVX2 {
        const __m256 slope = _mm256_div_ps(_mm256_sub_ps(x1, x0), _mm256_sub_ps(y1, y0));
        // The height of the center of the base row above the lower end of the edge, 0 … 1.
        const __m256 above = _mm256_sub_ps(_mm256_add_ps(base, half), y0);
        put(at, _mm256_fmadd_ps(slope, above, _mm256_sub_ps(x0, half)));
        put(step, slope);
    };
    putEdge(xP, yP, xQ, yQ, baseP, out.xPQ, out.stepPQ);
    putEdge(xQ, yQ, xR, yR, baseQ, out.xQR, out.stepQR);
    putEdge(xP, yP, xR, yR, baseP, out.xPR, out.stepPR);

    const __m256 x1 = _mm256_sub_ps(xB, xA), y1 = _mm256_sub_ps(yB, yA), x2 = _mm256_sub_ps(xC, xA),
                 y2 = _mm256_sub_ps(yC, yA);
    const __m256 area = _mm256_fmsub_ps(x1, y2, _mm256_mul_ps(x2, y1));
    const __m256 inverse = _mm256_div_ps(_mm256_set1_ps(1), area);
    const __m256 negative = _mm256_sub_ps(_mm256_setzero_ps(), inverse);
    put(out.xB, _mm256_mul_ps(y2, inverse));
    put(out.xC, _mm256_mul_ps(y1, negative));
    put(out.yB, _mm256_mul_ps(x2, negative));
    put(out.yC, _mm256_mul_ps(x1, inverse));
    put(out.originX, _mm256_sub_ps(xA, half));
    put(out.originY, _mm256_sub_ps(yA, half));
    return masks;
}

// Converts the upper half of a LitVertex, a color with numbers from 0 to 255, to an RGBA pixel.
OVAL4D_AVX2 inline std::uint32_t packPixel(__m128 color) {
    const __m128i numbers = _mm_cvtps_epi32(color), words = _mm_packus_epi32(numbers, numbers);
    return static_cast<std::uint32_t>(_mm_cvtsi128_si32(_mm_packus_epi16(words, words)));
}

// Draws triangle i of the eight triangles in `s`. A register holds the eight quantities of one pixel (see LitVertex),
// not eight pixels, because most rows of most triangles have fewer than eight pixels.
template <Blending blending>
OVAL4D_AVX2 inline void fillTriangle(const SurfaceCanvas& canvas, const TriangleSetup& s, std::size_t i,
                                     const LitVertex& pointA, const LitVertex& pointB, const LitVertex& pointC) {
    const __m256 a = _mm256_load_ps(&pointA.nearness), b = _mm256_load_ps(&pointB.nearness),
                 c = _mm256_load_ps(&pointC.nearness);
    // Each quantity is clamped to the range of its values at the corners, because the gradients of narrow triangles are
    // inexact. Clamping also replaces the NaN of triangles with the area 0.
    const __m256 least = _mm256_min_ps(_mm256_min_ps(a, b), c), most = _mm256_max_ps(_mm256_max_ps(a, b), c);
    const __m256 toB = _mm256_sub_ps(b, a), toC = _mm256_sub_ps(c, a);
    const auto gradient = [&](const FloatLanes& ofB, const FloatLanes& ofC) OVAL4D_AVX2 {
        return _mm256_fmadd_ps(toC, _mm256_set1_ps(ofC[i]), _mm256_mul_ps(toB, _mm256_set1_ps(ofB[i])));
    };
    const __m256 alongX = gradient(s.xB, s.xC), alongY = gradient(s.yB, s.yC);
    const auto limit = static_cast<float>(canvas.width);
    const auto fillRows = [&](int begin, int end, float base, float x, float step) OVAL4D_AVX2 {
        for (int y = begin; y < end; ++y) {
            const auto row = static_cast<float>(y);
            const auto column = [limit](float at) OVAL4D_AVX2 {
                return static_cast<int>(std::ceil(std::min(limit, std::max(0.0F, at))));  // 0 if `at` is NaN
            };
            const int one = column(std::fma(step, row - base, x));
            const int other = column(std::fma(s.stepPR[i], row - s.baseP[i], s.xPR[i]));
            const int left = std::min(one, other), right = std::max(one, other);
            if (left >= right) continue;
            __m256 value = _mm256_fmadd_ps(alongY, _mm256_set1_ps(row - s.originY[i]), a);
            value = _mm256_fmadd_ps(alongX, _mm256_set1_ps(static_cast<float>(left) - s.originX[i]), value);
            const std::ptrdiff_t start = static_cast<std::ptrdiff_t>(y) * canvas.width;
            std::uint32_t* const pixels = canvas.pixels + start;
            float* const stored = canvas.nearness + start;
            for (int k = left; k < right; ++k, value = _mm256_add_ps(value, alongX)) {
                const __m256 at = _mm256_min_ps(_mm256_max_ps(value, least), most);
                const float nearness = _mm256_cvtss_f32(at);
                const bool isNearer = nearness > stored[k];
                __m128 color = _mm256_extractf128_ps(at, 1);
                if constexpr (blending == Blending::none) {
                    if (!isNearer) continue;
                    stored[k] = packFullyCoveredDepth(nearness);
                    pixels[k] = packPixel(color);
                } else {
                    if (!isNearer) {
                        const float uncovered = unpackUncoveredFraction(stored[k]);
                        if (!(uncovered > 0)) continue;
                        color = _mm_mul_ps(color, _mm_set1_ps(uncovered));
                    }
                    const __m128 old =
                        _mm_cvtepi32_ps(_mm_cvtepu8_epi32(_mm_cvtsi32_si128(static_cast<std::int32_t>(pixels[k]))));
                    const __m128 alpha = _mm_permute_ps(color, 0xff);
                    const __m128 kept = _mm_fnmadd_ps(alpha, _mm_set1_ps(1.0F / 255), _mm_set1_ps(1));
                    pixels[k] = packPixel(_mm_fmadd_ps(old, kept, color));
                }
            }
        }
    };
    fillRows(s.rowP[i], s.rowQ[i], s.baseP[i], s.xPQ[i], s.stepPQ[i]);
    fillRows(s.rowQ[i], s.rowR[i], s.baseQ[i], s.xQR[i], s.stepQR[i]);
}

// Draws the triangles of `wanted` (one bit for each of eight triangles) that come before the first triangle that must
// be clipped. Returns, as bits, all triangles of `wanted` that must be clipped.
template <Blending blending>
OVAL4D_AVX2 unsigned drawEightTriangles(const SurfaceCanvas& canvas, const LitVertex* points,
                                        const std::uint32_t* indices, unsigned wanted, TriangleSetup& lanes) {
    const TriangleMasks masks = setUpTriangles(canvas, points, indices, lanes);
    const unsigned clipped = masks.clipped & wanted;
    // Triangles must be drawn in order. So a later call draws the triangles after a clipped triangle.
    unsigned drawn = masks.drawn & wanted;
    if (clipped != 0) drawn &= (clipped & (0U - clipped)) - 1;
    for (; drawn != 0; drawn &= drawn - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(drawn));
        const std::uint32_t* const corners = indices + 3 * i;
        fillTriangle<blending>(canvas, lanes, i, points[corners[0]], points[corners[1]], points[corners[2]]);
    }
    return clipped;
}

}  // namespace

void SurfaceRasterizer::projectAndLight(scene::Viewport viewport, const scene::PictureStyle& style,
                                        const SurfaceBatch& surfaces) {
    viewport_ = viewport;
    surfaces_ = &surfaces;
    const Lighting lighting{.halfWidth = 0.5F * static_cast<float>(viewport.width),
                            .halfHeight = 0.5F * static_cast<float>(viewport.height),
                            .ambient = static_cast<float>(style.ambient),
                            .diffuse = static_cast<float>(style.diffuse),
                            .gloss = static_cast<float>(255 * style.specular),
                            .shininess = static_cast<unsigned>(std::lround(style.shininess)),
                            .light = style.light,
                            .halfVector = glm::normalize(style.light + glm::dvec3(0, 0, 1))};
    const std::size_t end = surfaces.vertices().size();
    points_.resize(end);
    const SurfaceVertex* const vertices = surfaces.vertices().data();
    std::size_t at = 0;
    for (; at + kLanes < end; at += kLanes) projectAndLightEight(lighting, vertices + at, points_.data() + at);
    std::array<SurfaceVertex, kLanes + 1> lastVertices{};
    std::array<LitVertex, kLanes> lastPoints;
    std::copy(vertices + at, vertices + end, lastVertices.begin());
    projectAndLightEight(lighting, lastVertices.data(), lastPoints.data());
    std::copy_n(lastPoints.begin(), end - at, points_.begin() + static_cast<std::ptrdiff_t>(at));
}

namespace {

template <Blending blending, typename DrawClipped>
void drawTriangles(const SurfaceCanvas& canvas, const LitVertex* points, std::span<const std::uint32_t> indices,
                   const DrawClipped& drawClipped) {
    TriangleSetup lanes;
    std::array<std::uint32_t, 3 * kLanes> last{};
    for (std::size_t at = 0; at < indices.size(); at += 3 * kLanes) {
        const std::uint32_t* eight = indices.data() + at;
        if (indices.size() - at < last.size()) {
            last = {};
            std::copy(indices.begin() + static_cast<std::ptrdiff_t>(at), indices.end(), last.begin());
            eight = last.data();
        }
        for (std::size_t next = at + kAhead; next < std::min(at + kAhead + 3 * kLanes, indices.size()); next += 3)
            __builtin_prefetch(points + indices[next]);
        unsigned wanted = 0xff;
        while (const unsigned clipped = drawEightTriangles<blending>(canvas, points, eight, wanted, lanes)) {
            const auto i = static_cast<unsigned>(std::countr_zero(clipped));
            drawClipped(eight + std::size_t{3} * i);
            wanted &= 0xfeU << i;
        }
    }
}

}  // namespace

void SurfaceRasterizer::draw(const SurfaceCanvas& canvas, std::span<const std::uint32_t> indices,
                             Blending blending) const {
    const auto clipped = [&](const std::uint32_t* corners) { drawClippedAtNearPlane(canvas, corners, blending); };
    if (blending == Blending::none) return drawTriangles<Blending::none>(canvas, points_.data(), indices, clipped);
    drawTriangles<Blending::alpha>(canvas, points_.data(), indices, clipped);
}

// Draws the part of a triangle that is in front of the eye at a depth of at least kNearPlane.
void SurfaceRasterizer::drawClippedAtNearPlane(const SurfaceCanvas& canvas, const std::uint32_t* corners,
                                               Blending blending) const {
    std::array<LitVertex, 4> polygon;
    std::size_t count = 0;
    const glm::vec2 half(0.5F * static_cast<float>(viewport_.width), 0.5F * static_cast<float>(viewport_.height));
    const auto add = [&](const glm::vec3& clip, const LitVertex& color) {
        LitVertex point = color;
        point.nearness = 1 / clip.z;
        point.x = (clip.x / clip.z + 1) * half.x;
        point.y = (clip.y / clip.z + 1) * half.y;
        polygon[count++] = point;
    };
    for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t from = corners[i], to = corners[(i + 1) % 3];
        const glm::vec3 &a = surfaces_->vertices()[from].clip, &b = surfaces_->vertices()[to].clip;
        const bool keepA = a.z >= kNearPlane, keepB = b.z >= kNearPlane;
        const LitVertex &colorA = points_[from], &colorB = points_[to];
        if (keepA) add(a, colorA);
        if (keepA == keepB) continue;
        const float t = (kNearPlane - a.z) / (b.z - a.z);
        LitVertex color = colorA;
        for (float LitVertex::* channel : {&LitVertex::r, &LitVertex::g, &LitVertex::b, &LitVertex::a})
            color.*channel += t * (colorB.*channel - colorA.*channel);
        add(a + t * (b - a), color);
    }
    if (count < 3 || std::any_of(
                         polygon.begin(), polygon.begin() + static_cast<std::ptrdiff_t>(count),
                         [](const LitVertex& p) { return !std::isfinite(p.x) || !std::isfinite(p.y); }))
        return;
    constexpr std::array<std::uint32_t, 6> kFan{0, 1, 2, 0, 2, 3};
    const std::span<const std::uint32_t> triangles = std::span(kFan).first(3 * (count - 2));
    const auto unclipped = [](const std::uint32_t*) {};
    if (blending == Blending::none) return drawTriangles<Blending::none>(canvas, polygon.data(), triangles, unclipped);
    drawTriangles<Blending::alpha>(canvas, polygon.data(), triangles, unclipped);
}

double SurfaceRasterizer::estimateMeanScreenY(std::span<const std::uint32_t> indices) const {
    constexpr std::size_t kStep = 3 * 32;
    const auto height = static_cast<float>(viewport_.height);
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t at = 0; at < indices.size(); at += kStep) {
        const float y = points_[indices[at]].y;
        if (!(y > 0 && y < height)) continue;
        sum += y;
        ++count;
    }
    return count == 0 ? 0.5 : sum / (static_cast<double>(count) * height);
}

#undef OVAL4D_AVX2

#else

void SurfaceRasterizer::projectAndLight(scene::Viewport /*viewport*/, const scene::PictureStyle& /*style*/,
                                        const SurfaceBatch& /*surfaces*/) {}
void SurfaceRasterizer::draw(const SurfaceCanvas& /*canvas*/, std::span<const std::uint32_t> /*indices*/,
                             Blending /*blending*/) const {}
void SurfaceRasterizer::drawClippedAtNearPlane(const SurfaceCanvas& /*canvas*/, const std::uint32_t* /*corners*/,
                                               Blending /*blending*/) const {}
double SurfaceRasterizer::estimateMeanScreenY(std::span<const std::uint32_t> /*indices*/) const { return 0.5; }

#endif

}  // namespace oval4d::render
