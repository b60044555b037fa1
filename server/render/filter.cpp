#include "render/filter.hpp"

#include <cstring>

namespace oval4d::render {

namespace {

constexpr std::uint8_t kUp = 2;

/// `count` pixels of RGBA minus those above them, as RGB.
void differPlain(const std::uint8_t* row, const std::uint8_t* above, std::uint8_t* out, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            out[3 * i + c] = static_cast<std::uint8_t>(row[4 * i + c] - above[4 * i + c]);
}

#if defined(__x86_64__)

using Block = std::uint8_t __attribute__((vector_size(16)));

// Four pixels at a time. Each store writes four bytes more than it has, which the next one overwrites; the last
// pixels of a row are left to the plain loop, so that nothing is written past the row.
__attribute__((target("ssse3"))) void differBlocks(const std::uint8_t* row, const std::uint8_t* above,
                                                   std::uint8_t* out, std::size_t count) {
    std::size_t i = 0;
    for (; i + 6 <= count; i += 4) {
        Block a, b;
        std::memcpy(&a, row + 4 * i, sizeof a);
        std::memcpy(&b, above + 4 * i, sizeof b);
        const Block d = a - b;
        const Block rgb = __builtin_shufflevector(d, d, 0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14, 3, 7, 11, 15);
        std::memcpy(out + 3 * i, &rgb, sizeof rgb);
    }
    differPlain(row + 4 * i, above + 4 * i, out + 3 * i, count - i);
}

void differ(const std::uint8_t* row, const std::uint8_t* above, std::uint8_t* out, std::size_t count) {
    static const bool blocks = __builtin_cpu_supports("ssse3") != 0;
    blocks ? differBlocks(row, above, out, count) : differPlain(row, above, out, count);
}

#else

void differ(const std::uint8_t* row, const std::uint8_t* above, std::uint8_t* out, std::size_t count) {
    differPlain(row, above, out, count);
}

#endif

}  // namespace

void filterUp(const Image& image, std::vector<std::uint8_t>& out) {
    const auto width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
    out.resize((3 * width + 1) * height);
    std::uint8_t* at = out.data();
    for (std::size_t y = 0; y < height; ++y, at += 3 * width + 1) {
        const std::uint8_t* row = image.pixels.data() + (height - 1 - y) * width * 4;
        at[0] = kUp;
        if (y == 0)
            for (std::size_t i = 0; i < width; ++i) std::memcpy(at + 1 + 3 * i, row + 4 * i, 3);
        else
            differ(row, row + width * 4, at + 1, width);
    }
}

}  // namespace oval4d::render
