#pragma once
// The files of the chunks of a Zarr array.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "errors/error.hpp"
#include "fields/readers/file_contents.hpp"
#include "fields/readers/folder_files.hpp"
#include "fields/readers/zarr_metadata.hpp"

namespace oval4d::fields {

/// Finds the stored bytes of the chunks of an array. A chunk is a file or a part of a shard; of a shard, only the index
/// and the needed chunks are read. Keeps the index of the shard that was read last.
class ZarrChunkFiles {
  public:
    /// `folder` and `array` must outlive this object.
    ZarrChunkFiles(const FolderFileReader& folder, const ZarrArrayMetadata& array) : folder_(folder), array_(array) {}

    /// Returns the stored bytes of the chunk with these indices. Returns an empty optional if the chunk is missing.
    /// Errors: `bad_field` if the shard of the chunk is damaged; those of the folder.
    Result<std::optional<FileContents>> chunkContentsOf(const std::vector<std::size_t>& index);

    /// Returns the name of the chunk in error messages, such as "the chunk 'c/0/0'".
    std::string chunkNameForErrors(const std::vector<std::size_t>& index) const;

  private:
    struct ChunkLocation {
        std::string path;    // the path of the chunk's file or shard
        std::size_t number;  // the number of the chunk among the chunks of its shard
    };
    ChunkLocation chunkLocationOf(std::vector<std::size_t> index) const;
    std::optional<Error> readShardIndex(std::string shard);

    const FolderFileReader& folder_;
    const ZarrArrayMetadata& array_;
    std::string shardPath_;                    // the path of the shard whose index was read last
    std::optional<FileContents> storedIndex_;  // the index of this shard and its checksum; empty if there is no such
                                               // shard
    std::span<const std::byte> shardIndex_;    // the part of `storedIndex_` before the checksum
};

}  // namespace oval4d::fields
