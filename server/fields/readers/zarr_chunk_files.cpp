#include "fields/readers/zarr_chunk_files.hpp"

#include <utility>

#include "text/message_text.hpp"

namespace oval4d::fields {

namespace {

Error damagedShardError(const std::string& path, const Error& error) {
    return badFieldError("the shard " + text::inQuotes(path) + " is damaged: " + error.message);
}

}  // namespace

ZarrChunkFiles::ChunkLocation ZarrChunkFiles::chunkLocationOf(std::vector<std::size_t> index) const {
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

std::string ZarrChunkFiles::chunkNameForErrors(const std::vector<std::size_t>& index) const {
    const ChunkLocation place = chunkLocationOf(index);
    const std::string file = text::inQuotes(place.path);
    return array_.shards ? "the chunk " + std::to_string(place.number) + " in the shard " + file : "the chunk " + file;
}

Result<std::optional<FileContents>> ZarrChunkFiles::chunkContentsOf(const std::vector<std::size_t>& index) {
    ChunkLocation place = chunkLocationOf(index);
    if (!array_.shards) return folder_(place.path, {});
    if (place.path != shardPath_) {
        if (auto error = readShardIndex(std::move(place.path))) return std::move(*error);
    }
    if (!storedIndex_) return std::optional<FileContents>();
    const std::optional<FilePart> part = chunkInShard(shardIndex_, *array_.shards, place.number);
    if (!part) return std::optional<FileContents>();
    auto chunk = folder_(shardPath_, *part);
    if (!chunk) return chunk.error();
    if (!*chunk || (*chunk)->bytes.size() < part->size)
        return damagedShardError(shardPath_, badFieldError("its index states a place beyond its end"));
    return chunk;
}

// Reads the index of a shard. The shard may be missing. Errors: `bad_field` if the shard is damaged; those of the
// folder.
std::optional<Error> ZarrChunkFiles::readShardIndex(std::string shard) {
    auto stored = folder_(shard, filePartOfShardIndex(*array_.shards));
    if (!stored) return stored.error();
    storedIndex_ = std::move(*stored);
    shardPath_ = std::move(shard);
    if (!storedIndex_) return {};
    const auto index = checkedShardIndex(storedIndex_->bytes, *array_.shards);
    if (!index) return damagedShardError(shardPath_, index.error());
    shardIndex_ = *index;
    return {};
}

}  // namespace oval4d::fields
