#pragma once
// Decompression of the chunks of arrays.

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <variant>

#include "errors/error.hpp"

namespace oval4d::fields {

/// The compression format of chunks.
enum class ChunkCodec : std::uint8_t {
    gzip,   ///< RFC 1952
    zlib,   ///< RFC 1950
    zstd,   ///< RFC 8878
    blosc,  ///< Blosc 1, with any of its compressors and shuffles
};

/// Returns the codec that has this name in Zarr's metadata; an empty optional if the name is unknown.
std::optional<ChunkCodec> chunkCodecNamed(std::string_view name);

/// Decompresses a chunk into `to`, which must have exactly the size of the decompressed chunk. A wrong size in the
/// header of a chunk is harmless, because no memory is allocated for it. Error: `bad_field` if the chunk is damaged,
/// too short or too long.
Result<std::monostate> decompress(ChunkCodec codec, std::span<const std::byte> chunk, std::span<std::byte> to);

}  // namespace oval4d::fields
