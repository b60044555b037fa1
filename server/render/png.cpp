// PNG files (W3C, Portable Network Graphics, third edition): one filter for all rows, one deflate pass; large pictures
// in two bands on two cores, each of which makes an IDAT of its own.
// https://www.w3.org/TR/png-3/

#include <isa-l/crc.h>
#include <isa-l/igzip_lib.h>

#include <cstring>
#include <functional>
#include <stdexcept>

#include "geometry/companion.hpp"
#include "render/filter.hpp"
#include "render/image.hpp"

namespace oval4d::render {

namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint8_t kSignature[] = {137, 'P', 'N', 'G', '\r', '\n', 26, '\n'};
// Keyword, then: not compressed, method 0, no language, no translated keyword.
constexpr char kStateHeader[] = "oval4d\0\0\0\0";
constexpr std::uint8_t kZlibHeader[] = {0x78, 1};  // RFC 1950: deflate, 32 KB back, fastest
constexpr int kLevel = 1;
constexpr std::uint32_t kLevelBuffer = ISAL_DEF_LVL1_DEFAULT;
constexpr std::size_t kLarge = 1'000'000;  // bytes; below it another core costs more than it gains

void store32(std::uint8_t* at, std::uint32_t value) {
    for (int i = 0; i < 4; ++i) at[i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
}

void append(Bytes& out, const void* data, std::size_t size) {
    if (size == 0) return;
    out.resize(out.size() + size);
    std::memcpy(out.data() + out.size() - size, data, size);
}

/// Begins a chunk at the end of `out`; its length and CRC are written by endChunk().
std::size_t beginChunk(Bytes& out, const char* type) {
    const std::size_t start = out.size();
    out.resize(start + 4);
    append(out, type, 4);
    return start;
}

void endChunk(Bytes& out, std::size_t start) {
    const std::size_t length = out.size() - start - 8;
    store32(out.data() + start, static_cast<std::uint32_t>(length));
    const std::uint32_t crc = crc32_gzip_refl(0, out.data() + start + 4, length + 4);
    out.resize(out.size() + 4);
    store32(out.data() + out.size() - 4, crc);
}

/// Appends `in` to `out` deflated; another piece may follow, unless it is the last one.
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

/// The Adler-32 (RFC 1950) of two pieces, one after the other, from those of each; `size` is that of the second.
std::uint32_t joined(std::uint32_t first, std::uint32_t second, std::size_t size) {
    constexpr std::uint64_t kBase = 65521;
    const std::uint64_t a = (first & 0xffffU) + kBase - 1;  // each begins with 1
    const std::uint64_t low = a + (second & 0xffffU);
    const std::uint64_t high = (first >> 16U) + (second >> 16U) + size % kBase * a;
    return static_cast<std::uint32_t>(((high % kBase) << 16U) | (low % kBase));
}

}  // namespace

void PngEncoder::encode(const ImageView& image, int from, int to, Band& band) {
    filterRows(image, from, to, band.filtered);
    band.checksum = isal_adler32(1, band.filtered.data(), band.filtered.size());
    band.chunk.clear();
    const std::size_t start = beginChunk(band.chunk, "IDAT");
    if (from == 0) append(band.chunk, kZlibHeader, sizeof kZlibHeader);
    deflate(band.filtered, to == image.height, band.levelBuffer, band.chunk);
    endChunk(band.chunk, start);
}

void PngEncoder::encode(const ImageView& image, std::string_view state, std::vector<std::uint8_t>& out) {
    const std::size_t size = (static_cast<std::size_t>(image.width) * 3 + 1) * static_cast<std::size_t>(image.height);
    if (image.width < 1 || image.height < 1 ||
        image.pixels.size() != static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 4)
        throw std::invalid_argument("an image without pixels, or with pixels missing, has no PNG file");
    if (size > UINT32_MAX / 2) throw std::invalid_argument("an image of more than 2 GB does not fit into one IDAT");

    auto& [upper, lower] = bands_;
    const int middle = size < kLarge || image.height < 2 ? image.height : image.height / 2;
    const auto encodeUpper = [&] { encode(image, 0, middle, upper); };
    const auto encodeLower = [&] { encode(image, middle, image.height, lower); };
    if (middle == image.height) {
        encodeUpper();
    } else {
        geometry::Companion::instance().doBoth(std::ref(encodeUpper), std::ref(encodeLower));
    }
    out.clear();
    append(out, kSignature, sizeof kSignature);

    std::size_t chunk = beginChunk(out, "IHDR");
    std::uint8_t header[13] = {0, 0, 0, 0, 0, 0, 0, 0, 8, 2, 0, 0, 0};  // 8 bits, RGB, not interlaced
    store32(header, static_cast<std::uint32_t>(image.width));
    store32(header + 4, static_cast<std::uint32_t>(image.height));
    append(out, header, sizeof header);
    endChunk(out, chunk);

    chunk = beginChunk(out, "iTXt");
    append(out, kStateHeader, sizeof kStateHeader);  // the literal's own end is the last separator
    append(out, state.data(), state.size());
    endChunk(out, chunk);

    append(out, upper.chunk.data(), upper.chunk.size());
    std::uint32_t checksum = upper.checksum;
    if (middle < image.height) {
        append(out, lower.chunk.data(), lower.chunk.size());
        checksum = joined(checksum, lower.checksum, lower.filtered.size());
    }
    chunk = beginChunk(out, "IDAT");
    out.resize(out.size() + 4);
    store32(out.data() + out.size() - 4, checksum);
    endChunk(out, chunk);

    chunk = beginChunk(out, "IEND");
    endChunk(out, chunk);
}

}  // namespace oval4d::render
