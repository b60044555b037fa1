#pragma once
// Shards: files that contain several chunks of a Zarr array (zarr-specs.readthedocs.io, codec sharding_indexed).

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <nlohmann/json.hpp>

#include "errors/error.hpp"
#include "fields/readers/file_contents.hpp"

namespace oval4d::fields {

/// The layout of a shard. An index at the start or the end of the shard states the place of each chunk.
struct ShardLayout {
    std::vector<std::size_t> chunks;  ///< the number of chunks along each dimension
    bool indexAtStart = false;
    bool bigEndian = false;    ///< whether the index is big-endian
    bool hasChecksum = false;  ///< whether a checksum (CRC-32C) follows the index

    std::size_t chunkCount() const;
};

/// Returns the layout of shards from the configuration of their codec. `shard` and `chunk` are the sizes of a shard and
/// of its chunks along each dimension. Errors: `bad_field`; `unsupported_format` if the index is compressed;
/// `too_large` if a shard has more than 2^22 chunks.
Result<ShardLayout> shardLayoutIn(const nlohmann::json& configuration, const std::vector<std::size_t>& shard,
                                  const std::vector<std::size_t>& chunk);

/// Returns the part of a shard that contains its index and the checksum of the index.
FilePart filePartOfShardIndex(const ShardLayout& layout);

/// Returns the index of a shard without its checksum. `stored` are the bytes of filePartOfShardIndex(). Error:
/// `bad_field` if there are fewer bytes, or if the checksum is wrong.
Result<std::span<const std::byte>> checkedShardIndex(std::span<const std::byte> stored, const ShardLayout& layout);

/// Returns the part of a shard that contains a chunk, as stated in the index. The part may lie beyond the end of the
/// file. Returns an empty optional if the shard does not have the chunk. `index` is the result of checkedShardIndex().
/// `number` is the place of the chunk among the chunks of the shard, in C order.
std::optional<FilePart> chunkInShard(std::span<const std::byte> index, const ShardLayout& layout, std::size_t number);

}  // namespace oval4d::fields
