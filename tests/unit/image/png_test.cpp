// Tests of PNG files: they are decoded with libpng, and checked chunk by chunk.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "image/png_filter.hpp"
#include "unit/render/pictures.hpp"

namespace oval4d::image {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct Chunk {
    std::string type;
    Bytes data;
    std::uint32_t crc, crcFound;
};

/// Returns the CRC that the PNG specification defines, computed bit by bit.
std::uint32_t crcOf(std::span<const std::uint8_t> bytes) {
    std::uint32_t crc = 0xffffffff;
    for (const std::uint8_t byte : bytes) {
        crc ^= byte;
        for (int i = 0; i < 8; ++i) crc = crc & 1 ? 0xedb88320 ^ crc >> 1 : crc >> 1;
    }
    return ~crc;
}

std::vector<Chunk> chunksOf(const Bytes& file) {
    const auto word = [&](std::size_t at) {
        return std::uint32_t{file[at]} << 24 | file[at + 1] << 16 | file[at + 2] << 8 | file[at + 3];
    };
    std::vector<Chunk> chunks;
    for (std::size_t at = 8; at + 12 <= file.size();) {
        const std::size_t length = word(at);
        if (at + 12 + length > file.size()) break;
        const std::span content(file.data() + at + 4, length + 4);
        chunks.push_back({std::string(content.begin(), content.begin() + 4), Bytes(content.begin() + 4, content.end()),
                          crcOf(content), word(at + 8 + length)});
        at += 12 + length;
    }
    return chunks;
}

enum class Kind { noise, flat, gradient };

Image makeImage(int width, int height, Kind kind, std::mt19937& random) {
    Image image{width, height, Bytes(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4)};
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = static_cast<std::uint8_t>(kind == Kind::noise  ? random()
                                                    : kind == Kind::flat ? i % 4 * 80
                                                                         : i / 64);
    return image;
}

void expectSamePixels(const Image& image, const Image& read) {
    ASSERT_EQ(read.width, image.width);
    ASSERT_EQ(read.height, image.height);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        if (i % 4 == 3) continue;
        ASSERT_EQ(read.pixels[i], image.pixels[i]) << "byte " << i;
    }
}

TEST(Png, EverySmallSizeReadsBack) {
    std::mt19937 random(1);
    PngEncoder encoder;
    Bytes file;
    for (int width = 1; width <= 40; ++width)
        for (const int height : {1, 2, 7}) {
            SCOPED_TRACE(testing::Message() << width << " × " << height);
            const Image image = makeImage(width, height, Kind::noise, random);
            encoder.encode(image, "{}", file);
            expectSamePixels(image, render::readPng(file));
        }
}

TEST(Png, RandomSizesAndContentsReadBack) {
    std::mt19937 random(2);
    std::uniform_int_distribution<int> size(1, 600);
    PngEncoder encoder;
    Bytes file;
    for (int i = 0; i < 30; ++i) {
        const Image image = makeImage(size(random), size(random), static_cast<Kind>(i % 3), random);
        SCOPED_TRACE(testing::Message() << image.width << " × " << image.height << ", kind " << i % 3);
        encoder.encode(image, std::string(static_cast<std::size_t>(i) * 50, 'x'), file);
        expectSamePixels(image, render::readPng(file));
    }
}

/// Returns an image like those that oval4d draws: boxes with uniform or slowly changing colors on a background.
Image paint(int width, int height, std::mt19937& random) {
    Image image = makeImage(width, height, Kind::flat, random);
    for (int box = 0; box < 6; ++box) {
        const int left = static_cast<int>(random() % static_cast<unsigned>(width));
        const int bottom = static_cast<int>(random() % static_cast<unsigned>(height));
        const auto color = random();
        const unsigned slope = random() % 4;
        for (int y = bottom; y < std::min(height, bottom + 20); ++y) {
            for (int x = left; x < std::min(width, left + 30); ++x) {
                const std::size_t pixel =
                    static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
                for (unsigned c = 0; c < 4; ++c) {
                    image.pixels[4 * pixel + c] =
                        static_cast<std::uint8_t>((color >> 8 * c) + slope * static_cast<unsigned>(x + y));
                }
            }
        }
    }
    return image;
}

TEST(Png, ThousandsOfPicturesReadBack) {
    std::mt19937 random(8);
    PngEncoder encoder;
    Bytes file;
    for (int i = 0; i < 2000; ++i) {
        const int width = 1 + static_cast<int>(random() % 80), height = 1 + static_cast<int>(random() % 60);
        SCOPED_TRACE(testing::Message() << "picture " << i << ", " << width << " × " << height);
        const Image image = paint(width, height, random);
        encoder.encode(image, "{}", file);
        expectSamePixels(image, render::readPng(file));
    }
}

/// Large images, which are encoded in two parts, can be decoded.
TEST(Png, LargePicturesReadBack) {
    std::mt19937 random(9);
    PngEncoder encoder;
    Bytes file;
    for (const auto& [width, height] : {std::pair{1280, 720},
                                        {641, 545},
                                        {7, 16384},
                                        {21, 16384},
                                        {16384, 21},
                                        {640, 9},
                                        {1921, 1081},
                                        {577, 577},
                                        {578, 578}}) {
        SCOPED_TRACE(testing::Message() << width << " × " << height);
        for (const Image& image : {paint(width, height, random), makeImage(width, height, Kind::noise, random)}) {
            encoder.encode(image, "{}", file);
            expectSamePixels(image, render::readPng(file));
        }
    }
}

TEST(Png, LongThinImagesReadBack) {
    std::mt19937 random(3);
    for (const auto& [width, height] : {std::pair{1, 16384}, {16384, 1}, {16384, 3}}) {
        const Image image = makeImage(width, height, Kind::noise, random);
        Bytes file;
        PngEncoder().encode(image, "", file);
        expectSamePixels(image, render::readPng(file));
    }
}

/// Returns an image in which alpha has all values. The colors are multiplied by alpha.
Image transparentImage(int width, int height, std::mt19937& random) {
    Image image = makeImage(width, height, Kind::noise, random);
    for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
        const unsigned alpha = image.pixels[i + 3] = static_cast<std::uint8_t>(i / 4 % 256);
        for (std::size_t c = 0; c < 3; ++c)
            image.pixels[i + c] = static_cast<std::uint8_t>((image.pixels[i + c] * alpha + 127) / 255);
    }
    return image;
}

TEST(Png, TransparentImagesReadBack) {
    std::mt19937 random(10);
    Bytes file;
    for (const auto& [width, height] : {std::pair{1, 1}, {1, 300}, {300, 1}, {33, 20}, {640, 480}}) {
        SCOPED_TRACE(testing::Message() << width << " × " << height);
        const Image image = transparentImage(width, height, random);
        PngEncoder().encode({image.width, image.height, image.pixels, true}, "{}", file);
        EXPECT_EQ(chunksOf(file)[0].data[9], 6) << "the color type";
        const Image read = render::readPng(file);
        ASSERT_EQ(read.pixels.size(), image.pixels.size());
        for (std::size_t i = 0; i < image.pixels.size(); ++i) {
            const int alpha = read.pixels[i | 3U];
            if (i % 4 == 3) {
                ASSERT_EQ(alpha, image.pixels[i]);
            } else {  // the colors in the file are not multiplied by alpha
                ASSERT_NEAR(read.pixels[i] * alpha / 255.0, image.pixels[i], 0.51) << "byte " << i;
            }
        }
    }
}

TEST(Png, ChunksAreInOrderWithValidChecksums) {
    std::mt19937 random(4);
    Bytes file;
    PngEncoder().encode(makeImage(33, 20, Kind::noise, random), R"({"type":"state"})", file);
    EXPECT_EQ(std::memcmp(file.data(), "\x89PNG\r\n\x1a\n", 8), 0);
    const std::vector<Chunk> chunks = chunksOf(file);
    std::vector<std::string> types;
    std::size_t size = 8;
    for (const Chunk& chunk : chunks) {
        types.push_back(chunk.type);
        EXPECT_EQ(chunk.crcFound, chunk.crc) << chunk.type;
        size += 12 + chunk.data.size();
    }
    EXPECT_EQ(types, (std::vector<std::string>{"IHDR", "iTXt", "IDAT", "IDAT", "IEND"}));
    EXPECT_EQ(size, file.size()) << "nothing follows the chunks";
    EXPECT_EQ(chunks[0].data, (Bytes{0, 0, 0, 33, 0, 0, 0, 20, 8, 2, 0, 0, 0}));
}

TEST(Png, StateIsTheTextWithKeywordOval4d) {
    const std::string state = R"({"type":"state","label":"w = −0.25 ✓"})";
    std::mt19937 random(5);
    Bytes file;
    PngEncoder().encode(makeImage(5, 5, Kind::flat, random), state, file);

    struct Source {
        const Bytes& bytes;
        std::size_t at;
    } source{file, 0};
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_set_read_fn(png, &source, [](png_structp p, png_bytep out, std::size_t count) {
        auto* from = static_cast<Source*>(png_get_io_ptr(p));
        std::memcpy(out, from->bytes.data() + from->at, count);
        from->at += count;
    });
    png_read_info(png, info);
    png_textp text = nullptr;
    int count = 0;
    png_get_text(png, info, &text, &count);
    ASSERT_EQ(count, 1);
    EXPECT_EQ(text[0].compression, PNG_ITXT_COMPRESSION_NONE);
    EXPECT_STREQ(text[0].key, "oval4d");
    EXPECT_STREQ(text[0].lang, "");
    EXPECT_EQ(std::string(text[0].text, text[0].itxt_length), state);
    png_destroy_read_struct(&png, &info, nullptr);
}

TEST(Png, OneEncoderServesManySizes) {
    std::mt19937 random(6);
    PngEncoder encoder;
    Bytes file, fresh;
    for (const int size : {300, 3, 150, 1}) {
        const Image image = makeImage(size, size, Kind::gradient, random);
        encoder.encode(image, "state", file);
        PngEncoder().encode(image, "state", fresh);
        EXPECT_EQ(file, fresh);
    }
}

TEST(Png, RefusesImagesThatLackPixels) {
    Bytes file;
    EXPECT_THROW(PngEncoder().encode(Image{0, 0, {}}, "", file), std::invalid_argument);
    EXPECT_THROW(PngEncoder().encode(Image{2, 2, Bytes(15)}, "", file), std::invalid_argument);
}

/// Returns the Paeth predictor that the PNG specification defines.
int paeth(int left, int above, int upperLeft) {
    const int sum = left + above - upperLeft;
    const int toLeft = std::abs(sum - left), toAbove = std::abs(sum - above), toUpperLeft = std::abs(sum - upperLeft);
    if (toLeft <= toAbove && toLeft <= toUpperLeft) return left;
    return toAbove <= toUpperLeft ? above : upperLeft;
}

TEST(Png, FilterIsPaethInAllRowsButTheFirst) {
    constexpr int kRows = 60;
    std::mt19937 random(7);
    for (int width = 1; width <= 20; ++width) {
        const Image image = makeImage(width, kRows, Kind::noise, random);
        Bytes rows;
        makeFilteredRows({image.width, image.height, image.pixels}, 0, kRows, rows);
        const std::size_t stride = 3 * static_cast<std::size_t>(width) + 1;
        ASSERT_EQ(rows.size(), kRows * stride);
        for (int y = 0; y < kRows; ++y) {
            const std::uint8_t* row = &rows[static_cast<std::size_t>(y) * stride];
            EXPECT_EQ(row[0], y == 0 ? 1 : 4) << "filter type of row " << y << " at width " << width;
            for (int x = 0; x < width; ++x) {
                for (std::size_t c = 0; c < 3; ++c) {
                    const auto at = [&](int i, int j) {
                        return i < 0 || j < 0 ? 0 : render::pixelAt(image, i, kRows - 1 - j)[c];
                    };
                    const int guess = paeth(at(x - 1, y), at(x, y - 1), at(x - 1, y - 1));
                    EXPECT_EQ(row[1 + static_cast<std::size_t>(x) * 3 + c], (at(x, y) - guess) & 255);
                }
            }
        }
    }
}

}  // namespace
}  // namespace oval4d::image
