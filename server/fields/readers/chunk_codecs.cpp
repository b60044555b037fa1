#include "fields/readers/chunk_codecs.hpp"

#include <blosc.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <utility>
#include <variant>

#include "fields/readers/gzip.hpp"

namespace oval4d::fields {

namespace {

constexpr auto kChunkCodecs = std::to_array<std::pair<std::string_view, ChunkCodec>>(
    {{"gzip", ChunkCodec::gzip}, {"zlib", ChunkCodec::zlib}, {"zstd", ChunkCodec::zstd}, {"blosc", ChunkCodec::blosc}});

const Error kDamaged{ErrorCode::bad_field, "it is damaged, or has another size than the metadata state"};

Result<std::monostate> inflateInto(GzipReader::StreamFormat format, std::span<const std::byte> chunk,
                                   std::span<std::byte> to) {
    GzipReader reader(chunk, format);
    if (!reader.decompressInto(to) || !reader.verifyEnd()) return kDamaged;
    return std::monostate{};
}

Result<std::monostate> decompressBlosc(std::span<const std::byte> chunk, std::span<std::byte> to) {
    std::size_t size = 0;
    // First check the sizes in the header of the chunk, which blosc_decompress_ctx() trusts.
    if (chunk.size() < BLOSC_MIN_HEADER_LENGTH || blosc_cbuffer_validate(chunk.data(), chunk.size(), &size) < 0 ||
        size != to.size() ||
        blosc_decompress_ctx(chunk.data(), to.data(), to.size(), 1) != static_cast<int>(to.size())) {
        return kDamaged;
    }
    return std::monostate{};
}

}  // namespace

std::optional<ChunkCodec> chunkCodecNamed(std::string_view name) {
    const auto* const found = std::ranges::find(kChunkCodecs, name, &std::pair<std::string_view, ChunkCodec>::first);
    if (found == kChunkCodecs.end()) return {};
    return found->second;
}

Result<std::monostate> decompress(ChunkCodec codec, std::span<const std::byte> chunk, std::span<std::byte> to) {
    switch (codec) {
        case ChunkCodec::gzip:
            return inflateInto(GzipReader::StreamFormat::gzip, chunk, to);
        case ChunkCodec::zlib:
            return inflateInto(GzipReader::StreamFormat::zlib, chunk, to);
        case ChunkCodec::zstd: {
            const std::size_t size = ZSTD_decompress(to.data(), to.size(), chunk.data(), chunk.size());
            if (ZSTD_isError(size) != 0 || size != to.size()) return kDamaged;
            return std::monostate{};
        }
        case ChunkCodec::blosc:
            return decompressBlosc(chunk, to);
    }
    return kDamaged;
}

}  // namespace oval4d::fields
