#include "image/png.hpp"

#include <isa-l/crc.h>
#include <isa-l/igzip_lib.h>

#include <cstring>
#include <functional>
#include <stdexcept>

#include "image/png_filter.hpp"

namespace oval4d::image {

namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint8_t kSignature[] = {137, 'P', 'N', 'G', '\r', '\n', 26, '\n'};
// The start of the data of an iTXt chunk (PNG specification, section 11.3.3.4): the keyword and a zero, no compression,
// compression method 0, then an empty language tag and an empty translated keyword, each with a terminating zero.
constexpr char kStateHeader[] = "oval4d\0\0\0\0";
// The zlib header (RFC 1950): the method deflate, a window of 32 KiB, and the fastest level.
constexpr std::uint8_t kZlibHeader[] = {0x78, 1};
constexpr int kLevel = 1;                                      // the compression level of igzip
constexpr std::uint32_t kLevelBuffer = ISAL_DEF_LVL1_DEFAULT;  // the working memory of this level, in bytes
// An image of at least this many bytes before compression is encoded on two cores. For a smaller image, two cores are
// not faster than one.
constexpr std::size_t kLarge = 1'000'000;

void writeBigEndian32(std::uint8_t* at, std::uint32_t value) {
    for (int i = 0; i < 4; ++i) at[i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
}

void append(Bytes& out, const void* data, std::size_t size) {
    if (size == 0) return;
    out.resize(out.size() + size);
    std::memcpy(out.data() + out.size() - size, data, size);
}

/// Begins a PNG chunk at the end of `out`, and returns the index in `out` at which the chunk starts. endChunk() later
/// writes the length and the CRC of the chunk.
std::size_t beginChunk(Bytes& out, const char* type) {
    const std::size_t start = out.size();
    out.resize(start + 4);
    append(out, type, 4);
    return start;
}

void endChunk(Bytes& out, std::size_t start) {
    const std::size_t length = out.size() - start - 8;
    writeBigEndian32(out.data() + start, static_cast<std::uint32_t>(length));
    const std::uint32_t crc = crc32_gzip_refl(0, out.data() + start + 4, length + 4);
    out.resize(out.size() + 4);
    writeBigEndian32(out.data() + out.size() - 4, crc);
}

/// Compresses `in` as one piece of a deflate stream, and appends the compressed piece to `out`. `last` says whether
/// this piece is the last one of the stream. `levelBuffer` is working memory. Throws std::runtime_error if igzip fails.
void deflate(Bytes& in, bool last, Bytes& levelBuffer, Bytes& out) {
    isal_zstream stream;
    isal_deflate_init(&stream);
    levelBuffer.resize(kLevelBuffer);
    stream.level = kLevel;
    stream.level_buf = levelBuffer.data();
    stream.level_buf_size = kLevelBuffer;
    stream.end_of_stream = last ? 1 : 0;
    stream.flush = last ? NO_FLUSH : FULL_FLUSH;
    stream.next_in = in.data();
    stream.avail_in = static_cast<std::uint32_t>(in.size());

    const std::size_t start = out.size();
    out.resize(start + in.size() / 4 + 1024);
    while (true) {
        stream.next_out = out.data() + start + stream.total_out;
        stream.avail_out = static_cast<std::uint32_t>(out.size() - start - stream.total_out);
        if (isal_deflate(&stream) != COMP_OK) throw std::runtime_error("igzip failed");
        if (last ? stream.internal_state.state == ZSTATE_END : stream.avail_in == 0 && stream.avail_out > 0) break;
        out.resize(out.size() + in.size() / 2 + 1024);
    }
    out.resize(start + stream.total_out);
}

/// Returns the Adler-32 checksum (RFC 1950) of two concatenated byte strings. `first` and `second` are the checksums of
/// the two strings, and `size` is the size of the second string in bytes.
std::uint32_t combinedAdler32(std::uint32_t first, std::uint32_t second, std::size_t size) {
    constexpr std::uint64_t kBase = 65521;
    const std::uint64_t a = (first & 0xffffU) + kBase - 1;  // − 1: only one of the two initial 1s counts
    const std::uint64_t low = a + (second & 0xffffU);
    const std::uint64_t high = (first >> 16U) + (second >> 16U) + size % kBase * a;
    return static_cast<std::uint32_t>(((high % kBase) << 16U) | (low % kBase));
}

}  // namespace

void PngEncoder::encode(const ImageView& image, int from, int to, ImageBand& band) {
    makeFilteredRows(image, from, to, band.filtered);
    band.checksum = isal_adler32(1, band.filtered.data(), band.filtered.size());
    band.chunk.clear();
    const std::size_t start = beginChunk(band.chunk, "IDAT");
    if (from == 0) append(band.chunk, kZlibHeader, sizeof kZlibHeader);
    deflate(band.filtered, to == image.height, band.levelBuffer, band.chunk);
    endChunk(band.chunk, start);
}

void PngEncoder::encode(const ImageView& image, std::string_view state, std::vector<std::uint8_t>& out) {
    const std::size_t channels = image.hasAlpha ? 4 : 3;
    const std::size_t size =
        (static_cast<std::size_t>(image.width) * channels + 1) * static_cast<std::size_t>(image.height);
    if (image.width < 1 || image.height < 1 ||
        image.pixels.size() != static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 4)
        throw std::invalid_argument("cannot encode an image that is empty or lacks pixels");
    if (size > UINT32_MAX / 2) throw std::invalid_argument("cannot encode an image of more than 2 GiB");

    auto& [upper, lower] = bands_;
    const int middle = size < kLarge || image.height < 2 ? image.height : image.height / 2;
    const auto encodeUpper = [&] { encode(image, 0, middle, upper); };
    const auto encodeLower = [&] { encode(image, middle, image.height, lower); };
    if (middle == image.height) {
        encodeUpper();
    } else {
        parallel::invoke(forkJoin_, std::ref(encodeUpper), std::ref(encodeLower));
    }
    out.clear();
    append(out, kSignature, sizeof kSignature);

    std::size_t chunk = beginChunk(out, "IHDR");
    const std::uint8_t colorType = image.hasAlpha ? 6 : 2;  // the PNG color type: RGBA (6) or RGB (2)
    std::uint8_t header[13] = {0, 0, 0, 0, 0, 0, 0, 0, 8, colorType, 0, 0, 0};  // 8 bits per channel, not interlaced
    writeBigEndian32(header, static_cast<std::uint32_t>(image.width));
    writeBigEndian32(header + 4, static_cast<std::uint32_t>(image.height));
    append(out, header, sizeof header);
    endChunk(out, chunk);

    chunk = beginChunk(out, "iTXt");
    append(out, kStateHeader, sizeof kStateHeader);  // includes the final zero, which ends the translated keyword
    append(out, state.data(), state.size());
    endChunk(out, chunk);

    append(out, upper.chunk.data(), upper.chunk.size());
    std::uint32_t checksum = upper.checksum;
    if (middle < image.height) {
        append(out, lower.chunk.data(), lower.chunk.size());
        checksum = combinedAdler32(checksum, lower.checksum, lower.filtered.size());
    }
    chunk = beginChunk(out, "IDAT");
    out.resize(out.size() + 4);
    writeBigEndian32(out.data() + out.size() - 4, checksum);
    endChunk(out, chunk);

    chunk = beginChunk(out, "IEND");
    endChunk(out, chunk);
}

}  // namespace oval4d::image
