// PNG files (W3C, Portable Network Graphics, third edition): one filter for all rows, one deflate pass, one IDAT.
// https://www.w3.org/TR/png-3/

#include <isa-l/crc.h>
#include <isa-l/igzip_lib.h>

#include <cstring>
#include <stdexcept>

#include "render/filter.hpp"
#include "render/image.hpp"

namespace oval4d::render {

namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint8_t kSignature[] = {137, 'P', 'N', 'G', '\r', '\n', 26, '\n'};
// Keyword, then: not compressed, method 0, no language, no translated keyword.
constexpr char kStateHeader[] = "oval4d\0\0\0\0";
constexpr int kLevel = 1;
constexpr std::uint32_t kLevelBuffer = ISAL_DEF_LVL1_DEFAULT;

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

/// Appends `in` to `out` as one zlib stream.
void deflate(Bytes& in, Bytes& levelBuffer, Bytes& out) {
    isal_zstream stream;
    isal_deflate_init(&stream);
    levelBuffer.resize(kLevelBuffer);
    stream.level = kLevel;
    stream.level_buf = levelBuffer.data();
    stream.level_buf_size = kLevelBuffer;
    stream.gzip_flag = IGZIP_ZLIB;
    stream.end_of_stream = 1;
    stream.flush = NO_FLUSH;
    stream.next_in = in.data();
    stream.avail_in = static_cast<std::uint32_t>(in.size());

    const std::size_t start = out.size();
    out.resize(start + in.size() / 4 + 1024);
    while (true) {
        stream.next_out = out.data() + start + stream.total_out;
        stream.avail_out = static_cast<std::uint32_t>(out.size() - start - stream.total_out);
        if (isal_deflate(&stream) != COMP_OK) throw std::runtime_error("igzip failed");
        if (stream.internal_state.state == ZSTATE_END) break;
        out.resize(out.size() + in.size() / 2 + 1024);
    }
    out.resize(start + stream.total_out);
}

}  // namespace

void PngEncoder::encode(const ImageView& image, std::string_view state, std::vector<std::uint8_t>& out) {
    const std::size_t size = (static_cast<std::size_t>(image.width) * 3 + 1) * static_cast<std::size_t>(image.height);
    if (image.width < 1 || image.height < 1 ||
        image.pixels.size() != static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 4)
        throw std::invalid_argument("an image without pixels, or with pixels missing, has no PNG file");
    if (size > UINT32_MAX / 2) throw std::invalid_argument("an image of more than 2 GB does not fit into one IDAT");

    filterRows(image, filtered_);
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

    chunk = beginChunk(out, "IDAT");
    deflate(filtered_, levelBuffer_, out);
    endChunk(out, chunk);

    chunk = beginChunk(out, "IEND");
    endChunk(out, chunk);
}

}  // namespace oval4d::render
