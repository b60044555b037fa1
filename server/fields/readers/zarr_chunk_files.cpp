#include "fields/readers/zarr_chunk_files.hpp"

#include <utility>

#include "text/message_text.hpp"

namespace oval4d::fields {

namespace {

Error inShard(const std::string& path, const Error& error) {
    return badField("the shard " + text::inQuotes(path) + " is damaged: " + error.message);
}

}  // namespace

ZarrChunkFiles::ChunkPlace ZarrChunkFiles::placeOf(std::vector<std::size_t> index) const {
    std::size_t number = 0;
    if (array_.shards) {
        for (std::size_t i = 0; i < index.size(); ++i) {
            const std::size_t chunks = array_.shards->chunks[i];
            number = number * chunks + index[i] % chunks;
            index[i] /= chunks;
        }
    }
    return {array_.chunkPath(index), number};
}

std::string ZarrChunkFiles::nameOf(const std::vector<std::size_t>& index) const {
    const ChunkPlace place = placeOf(index);
    const std::string file = text::inQuotes(place.path);
    return array_.shards ? "the chunk " + std::to_string(place.number) + " in the shard " + file : "the chunk " + file;
}

Result<std::optional<FileContents>> ZarrChunkFiles::contentsOf(const std::vector<std::size_t>& index) {
    ChunkPlace place = placeOf(index);
    if (!array_.shards) return folder_(place.path);
    if (place.path == shardPath_) return chunkInOpenShard(place.number);
    auto file = folder_(place.path);
    if (!file) return file.error();
    shardPath_ = std::move(place.path);
    shard_ = std::move(*file);
    if (!shard_) return std::optional<FileContents>();
    const auto found = shardIndexIn(shard_->bytes, *array_.shards);
    if (!found) return inShard(shardPath_, found.error());
    shardIndex_ = *found;
    return chunkInOpenShard(place.number);
}

Result<std::optional<FileContents>> ZarrChunkFiles::chunkInOpenShard(std::size_t number) const {
    if (!shard_) return std::optional<FileContents>();
    const auto chunk = chunkInShard(shard_->bytes, shardIndex_, *array_.shards, number);
    if (!chunk) return inShard(shardPath_, chunk.error());
    if (!*chunk) return std::optional<FileContents>();
    return std::optional(FileContents{shard_->owner, **chunk, shard_->file});
}

}  // namespace oval4d::fields
