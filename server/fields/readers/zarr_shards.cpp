#include "fields/readers/zarr_shards.hpp"

#include <isa-l/crc.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <string>

#include "fields/readers/zarr_json.hpp"

namespace oval4d::fields {

using nlohmann::json;

namespace {

constexpr std::size_t kMaxChunks = std::size_t{1} << 22U;       // the maximum number of chunks in a shard
constexpr std::size_t kEntryBytes = 2 * sizeof(std::uint64_t);  // the size of an entry of the index: the offset and the
                                                                // size of a chunk
constexpr std::size_t kChecksumBytes = sizeof(std::uint32_t);

Error shardDamageError(const std::string& why) { return {ErrorCode::bad_field, why}; }

template <typename Number>
Number loadInteger(const std::byte* from, bool bigEndian) {
    Number number = 0;
    for (std::size_t i = 0; i < sizeof number; ++i) {
        const std::size_t at = bigEndian ? i : sizeof number - 1 - i;
        number = static_cast<Number>(number << 8U) | std::to_integer<Number>(from[at]);
    }
    return number;
}

std::uint32_t crc32cOf(std::span<const std::byte> bytes) {
    constexpr std::uint32_t kAllBits = std::numeric_limits<std::uint32_t>::max();
    auto* const from = const_cast<std::uint8_t*>(reinterpret_cast<const std::uint8_t*>(bytes.data()));
    return crc32_iscsi(from, static_cast<int>(bytes.size()), kAllBits) ^ kAllBits;
}

std::string codecNameOf(const json& codec) {
    return codec.is_string() ? codec.get<std::string>() : stringMember(codec, "name");
}

}  // namespace

std::size_t ShardLayout::chunkCount() const {
    return std::accumulate(chunks.begin(), chunks.end(), std::size_t{1}, std::multiplies<>());
}

Result<ShardLayout> shardLayoutIn(const json& configuration, const std::vector<std::size_t>& shard,
                                  const std::vector<std::size_t>& chunk) {
    if (chunk.size() != shard.size())
        return badMetadataError("the shapes of a shard and of its chunks differ in length");
    ShardLayout layout;
    std::size_t count = 1;
    for (std::size_t i = 0; i < shard.size(); ++i) {
        if (shard[i] % chunk[i] != 0)
            return badMetadataError("the size of a shard is not a multiple of the size of its chunks");
        layout.chunks.push_back(shard[i] / chunk[i]);
        if (layout.chunks.back() > kMaxChunks / count)
            return Error{ErrorCode::too_large, "a shard of the Zarr array has more than the allowed 2^22 chunks"};
        count *= layout.chunks.back();
    }
    const std::string location = stringMember(configuration, "index_location");
    if (!location.empty() && location != "start" && location != "end")
        return badMetadataError("index_location must be start or end");
    layout.indexAtStart = location == "start";
    const json* const codecs = findMember(configuration, "index_codecs");
    const std::size_t codecCount = codecs != nullptr && codecs->is_array() ? codecs->size() : 0;
    layout.hasChecksum = codecCount == 2 && codecNameOf((*codecs)[1]) == "crc32c";
    if (codecCount == 0 || codecNameOf((*codecs)[0]) != "bytes" || codecCount != (layout.hasChecksum ? 2U : 1U)) {
        return Error{ErrorCode::unsupported_format,
                     "the Zarr array has shards whose index has other codecs than bytes and crc32c, which the server "
                     "does not read"};
    }
    const json* const ofBytes = findMember((*codecs)[0], "configuration");
    const std::string endian = ofBytes == nullptr ? "" : stringMember(*ofBytes, "endian");
    if (endian != "little" && endian != "big") return badMetadataError("endian must be little or big");
    layout.bigEndian = endian == "big";
    return layout;
}

FilePart filePartOfShardIndex(const ShardLayout& layout) {
    const std::size_t size = layout.chunkCount() * kEntryBytes + (layout.hasChecksum ? kChecksumBytes : 0);
    return {0, size, !layout.indexAtStart};
}

Result<std::span<const std::byte>> checkedShardIndex(std::span<const std::byte> stored, const ShardLayout& layout) {
    if (stored.size() < filePartOfShardIndex(layout).size) return shardDamageError("it is shorter than its index");
    const std::size_t size = layout.chunkCount() * kEntryBytes;
    const std::span<const std::byte> index = stored.first(size);
    if (layout.hasChecksum && loadInteger<std::uint32_t>(stored.data() + size, false) != crc32cOf(index))
        return shardDamageError("the checksum of its index is wrong");
    return index;
}

std::optional<FilePart> chunkInShard(std::span<const std::byte> index, const ShardLayout& layout, std::size_t number) {
    constexpr std::uint64_t kMissing = std::numeric_limits<std::uint64_t>::max();
    const std::byte* const entry = index.data() + number * kEntryBytes;
    const auto offset = loadInteger<std::uint64_t>(entry, layout.bigEndian);
    const auto size = loadInteger<std::uint64_t>(entry + sizeof offset, layout.bigEndian);
    if (offset == kMissing && size == kMissing) return {};
    return FilePart{offset, size};
}

}  // namespace oval4d::fields
