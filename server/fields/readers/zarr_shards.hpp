#pragma once
// Shards: files that contain several chunks of a Zarr array (zarr-specs.readthedocs.io, codec sharding_indexed).

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <nlohmann/json.hpp>

#include "errors/error.hpp"

namespace oval4d::fields {

/// How chunks lie in a shard. An index at the start or the end of the shard has the place of each chunk.
struct ShardLayout {
    std::vector<std::size_t> chunks;  ///< the number of chunks along each dimension
    bool indexAtStart = false;
    bool bigEndian = false;    ///< the byte order of the index
    bool hasChecksum = false;  ///< whether a checksum (CRC-32C) follows the index

    std::size_t chunkCount() const;
};

/// Returns the layout that the configuration of the codec states. `shard` and `chunk` are the sizes of a shard and of
/// its chunks along each dimension. Errors: `bad_field`; `unsupported_format` if the index is compressed; `too_large`
/// if a shard has more than 2^22 chunks.
Result<ShardLayout> shardLayoutIn(const nlohmann::json& configuration, const std::vector<std::size_t>& shard,
                                  const std::vector<std::size_t>& chunk);

/// Returns the index of a shard. `shard`: the bytes of the file, of which only those of the index are read. Error:
/// `bad_field` if the file is too short, or if the checksum is wrong.
Result<std::span<const std::byte>> shardIndexIn(std::span<const std::byte> shard, const ShardLayout& layout);

/// Returns the bytes of a chunk; an empty optional if the shard does not have it. `index` is that of the shard, and
/// `number` the place of the chunk among the chunks of the shard, in C order. Error: `bad_field` if the index states a
/// place beyond the file.
Result<std::optional<std::span<const std::byte>>> chunkInShard(std::span<const std::byte> shard,
                                                               std::span<const std::byte> index,
                                                               const ShardLayout& layout, std::size_t number);

}  // namespace oval4d::fields
