#include "image/png_filter.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <utility>

// All rows except the first have the same filter. Choosing the best filter for each row, as libpng does, would take
// longer than the compression, and would not make the files of oval4d's pictures smaller.

namespace oval4d::image {

namespace {

constexpr std::uint8_t kSub = 1, kPaeth = 4;

int paeth(int left, int above, int upperLeft) {
    const int toLeft = std::abs(above - upperLeft), toAbove = std::abs(left - upperLeft);
    const int toUpperLeft = std::abs(left + above - 2 * upperLeft);
    if (toLeft <= toAbove && toLeft <= toUpperLeft) return left;
    return toAbove <= toUpperLeft ? above : upperLeft;
}

/// Subtracts the Paeth prediction from `count` RGBA pixels, which begin at `row`, and writes the differences as RGB to
/// `out`. `above` points to the pixel above `row`. Also reads the pixels to the left of `row` and of `above`.
void subtractPaethScalar(const std::uint8_t* row, const std::uint8_t* above, std::uint8_t* out, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            const std::uint8_t* here = row + 4 * i + c;
            const std::uint8_t* up = above + 4 * i + c;
            out[3 * i + c] = static_cast<std::uint8_t>(*here - paeth(here[-4], *up, up[-4]));
        }
    }
}

#if defined(__x86_64__)

using EightPixels = std::uint8_t __attribute__((vector_size(32)));

// Does the same as subtractPaethScalar(), but processes eight pixels at a time, in 8-bit arithmetic. Let x be the
// pixel, and a, b and c its left, upper and upper-left neighbors. The prediction of x is the one of a, b and c that is
// nearest to a + b − c. If a and b are both greater or both less than c, then c is the farthest from a + b − c. In this
// case, the exact distance of c does not matter; it may not fit into a byte.
//
// Each store writes eight bytes too many, which the next store overwrites. subtractPaethScalar() processes the last
// pixels of a row, so that no byte is written past the end of the row.
__attribute__((target("avx2"))) void subtractPaethAvx2(const std::uint8_t* row, const std::uint8_t* above,
                                                       std::uint8_t* out, std::size_t count) {
    std::size_t i = 0;
    for (; i + 11 <= count; i += 8) {
        EightPixels x, a, b, c;
        std::memcpy(&x, row + 4 * i, sizeof x);
        std::memcpy(&a, row + 4 * i - 4, sizeof a);
        std::memcpy(&b, above + 4 * i, sizeof b);
        std::memcpy(&c, above + 4 * i - 4, sizeof c);
        const EightPixels mostA = a > c ? a : c, leastA = a < c ? a : c;
        const EightPixels mostB = b > c ? b : c, leastB = b < c ? b : c;
        const EightPixels toA = mostB - leastB, toB = mostA - leastA;
        const EightPixels nearer = toA < toB ? toA : toB, farther = toA > toB ? toA : toB;
        const EightPixels sameSide = (mostA == a) == (mostB == b);
        const EightPixels toC = (farther - nearer) | sameSide;
        const EightPixels best = nearer < toC ? nearer : toC;
        const EightPixels d = x - (best == toA ? a : best == toB ? b : c);
        const EightPixels rgb = __builtin_shufflevector(d, d, 0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14, 16, 17, 18, 20,
                                                        21, 22, 24, 25, 26, 28, 29, 30, 3, 7, 11, 15, 19, 23, 27, 31);
        std::memcpy(out + 3 * i, &rgb, sizeof rgb);
    }
    subtractPaethScalar(row + 4 * i, above + 4 * i, out + 3 * i, count - i);
}

void subtractPaeth(const std::uint8_t* row, const std::uint8_t* above, std::uint8_t* out, std::size_t count) {
    static const bool blocks = __builtin_cpu_supports("avx2") != 0;
    blocks ? subtractPaethAvx2(row, above, out, count) : subtractPaethScalar(row, above, out, count);
}

#else

void subtractPaeth(const std::uint8_t* row, const std::uint8_t* above, std::uint8_t* out, std::size_t count) {
    subtractPaethScalar(row, above, out, count);
}

#endif

/// Returns the RGBA pixels of row y of an image, where row 0 is the top of the image.
const std::uint8_t* pixelRow(const image::ImageView& image, int y) {
    return image.pixels.data() +
           static_cast<std::size_t>(image.height - 1 - y) * static_cast<std::size_t>(image.width) * 4;
}

/// Writes the RGBA pixels of a row to `out`, with the colors divided by alpha. `out` must have the size of the row.
void divideByAlpha(const std::uint8_t* row, std::vector<std::uint8_t>& out) {
    for (std::size_t i = 0; i < out.size(); i += 4) {
        const unsigned alpha = row[i + 3];
        for (std::size_t c = 0; c < 3; ++c) {
            const unsigned color = alpha == 0 ? 0 : (255U * row[i + c] + alpha / 2) / alpha;
            out[i + c] = static_cast<std::uint8_t>(std::min(color, 255U));
        }
        out[i + 3] = static_cast<std::uint8_t>(alpha);
    }
}

/// Writes the filtered rows of an image with alpha, as makeFilteredRows() specifies. Processes one byte at a time,
/// because such images need not be encoded as fast as the pictures of a live view.
void makeFilteredAlphaRows(const image::ImageView& image, int from, int to, std::vector<std::uint8_t>& out) {
    const std::size_t bytes = 4 * static_cast<std::size_t>(image.width);
    out.resize((bytes + 1) * static_cast<std::size_t>(to - from));
    std::vector<std::uint8_t> row(bytes), above(bytes);
    if (from > 0) divideByAlpha(pixelRow(image, from - 1), above);
    std::uint8_t* at = out.data();
    for (int y = from; y < to; ++y) {
        divideByAlpha(pixelRow(image, y), row);
        *at++ = y == 0 ? kSub : kPaeth;
        for (std::size_t i = 0; i < bytes; ++i) {
            // In row 0, `above` contains zeros. Then the filter Paeth predicts the left neighbor, as the filter Sub
            // does.
            const int left = i < 4 ? 0 : row[i - 4], upperLeft = i < 4 ? 0 : above[i - 4];
            *at++ = static_cast<std::uint8_t>(row[i] - paeth(left, above[i], upperLeft));
        }
        std::swap(row, above);
    }
}

}  // namespace

void makeFilteredRows(const image::ImageView& image, int from, int to, std::vector<std::uint8_t>& out) {
    if (image.hasAlpha) {
        makeFilteredAlphaRows(image, from, to, out);
        return;
    }
    const auto width = static_cast<std::size_t>(image.width);
    out.resize((3 * width + 1) * static_cast<std::size_t>(to - from));
    std::uint8_t* at = out.data();
    for (int y = from; y < to; ++y, at += 3 * width + 1) {
        const std::uint8_t* row = pixelRow(image, y);
        const std::uint8_t* above = row + width * 4;
        at[0] = y == 0 ? kSub : kPaeth;
        // The first pixel of a row has no left neighbor, so Sub predicts 0, and Paeth predicts the upper neighbor.
        for (std::size_t c = 0; c < 3; ++c) {
            at[1 + c] = static_cast<std::uint8_t>(row[c] - (y == 0 ? 0 : above[c]));
        }
        if (y == 0) {
            for (std::size_t i = 1; i < width; ++i) {
                for (std::size_t c = 0; c < 3; ++c) {
                    at[1 + 3 * i + c] = static_cast<std::uint8_t>(row[4 * i + c] - row[4 * i + c - 4]);
                }
            }
        } else {
            subtractPaeth(row + 4, above + 4, at + 4, width - 1);
        }
    }
}

}  // namespace oval4d::image
