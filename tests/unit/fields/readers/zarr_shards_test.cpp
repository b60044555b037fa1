#include "fields/readers/zarr_shards.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "unit/fields/readers/files.hpp"
#include "unit/fields/readers/zarr_files.hpp"

namespace oval4d::fields::test {
namespace {

// Returns the checksum CRC-32C (RFC 3720, appendix B.4), computed bit by bit.
std::uint32_t crc32c(const std::string& bytes) {
    std::uint32_t crc = ~std::uint32_t{0};
    for (const char byte : bytes) {
        crc ^= static_cast<std::uint8_t>(byte);
        for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? 0x82F63B78U : 0U);
    }
    return ~crc;
}

// Returns the bytes of a shard with room for 4 chunks. `chunks` maps the numbers of the chunks in the shard to their
// bytes.
std::string shardOf(const std::map<std::size_t, std::string>& chunks, bool indexAtStart) {
    constexpr std::size_t kCount = 4, kIndexSize = 16 * kCount + 4;
    std::string body, index;
    for (std::size_t number = 0; number < kCount; ++number) {
        const auto found = chunks.find(number);
        const bool isMissing = found == chunks.end();
        const std::uint64_t offset = (indexAtStart ? kIndexSize : std::size_t{0}) + body.size();
        index += bytesOf(isMissing ? ~std::uint64_t{0} : offset);
        index += bytesOf(isMissing ? ~std::uint64_t{0} : std::uint64_t{found->second.size()});
        if (!isMissing) body += found->second;
    }
    index += bytesOf(crc32c(index));
    return indexAtStart ? index + body : body + index;
}

// Returns the metadata of an array of 3 × 6 numbers, in shards of 2 × 4 numbers and chunks of 1 × 2 numbers.
std::string shardedArray(const std::string& indexLocation) {
    return R"({"zarr_format":3,"node_type":"array","shape":[3,6],"fill_value":7,"data_type":"float32",
        "chunk_grid":{"name":"regular","configuration":{"chunk_shape":[2,4]}},
        "chunk_key_encoding":{"name":"default"},
        "codecs":[{"name":"sharding_indexed","configuration":{"chunk_shape":[1,2],"index_location":")" +
           indexLocation + R"(","codecs":[{"name":"bytes","configuration":{"endian":"little"}}],
            "index_codecs":[{"name":"bytes","configuration":{"endian":"little"}},{"name":"crc32c"}]}}]})";
}

TEST(ZarrShards, ReadsChunksOfShards) {
    for (const bool indexAtStart : {false, true}) {
        const auto shard = [&](const std::map<std::size_t, std::string>& chunks) {
            return shardOf(chunks, indexAtStart);
        };
        const Files files{{"zarr.json", shardedArray(indexAtStart ? "start" : "end")},
                          {"c/0/0", shard({{0, chunkOf({0, 1})}, {1, chunkOf({2, 3})}, {2, chunkOf({10, 11})}})},
                          {"c/0/1", shard({{0, chunkOf({4, 5})}, {2, chunkOf({14, 15})}})},
                          {"c/1/0", shard({{0, chunkOf({20, 21})}, {1, chunkOf({22, 23})}})}};
        const auto field = readFiles(files);
        ASSERT_TRUE(field) << field.error().message;
        const auto samples = field->samples.values();
        EXPECT_EQ(std::vector(samples.begin(), samples.end()),
                  (std::vector<float>{0, 1, 2, 3, 4, 5, 10, 11, 7, 7, 14, 15, 20, 21, 22, 23, 7, 7}));
        std::set<std::string> opened;
        const Box box{{0, 0, 0, 0}, {5, 2, 0, 0}}, region{{4, 0, 0, 0}, {5, 1, 0, 0}};
        const auto part = readFiles(files, FieldReadOptions{.box = box, .region = region}, &opened);
        ASSERT_TRUE(part) << part.error().message;
        const auto ofPart = part->samples.values();
        EXPECT_EQ(std::vector(ofPart.begin(), ofPart.end()), (std::vector<float>{4, 5, 14, 15}));
        EXPECT_TRUE(opened.contains("c/0/1") && !opened.contains("c/0/0") && !opened.contains("c/1/1"));
    }
}

TEST(ZarrShards, ReadsTheIndexOfAShardOnceAndOtherwiseOnlyItsChunks) {
    const std::string shard =
        shardOf({{0, chunkOf({0, 1})}, {1, chunkOf({2, 3})}, {2, chunkOf({10, 11})}, {3, chunkOf({12, 13})}}, false);
    const Files files{{"zarr.json", shardedArray("end")}, {"c/0/0", shard}, {"c/0/1", shard}};
    std::vector<std::string> read;  // the parts of the shards that were read
    const FolderFileReader folder = [&](const std::string& path,
                                        const FilePart& part) -> Result<std::optional<FileContents>> {
        if (path.starts_with('c'))
            read.push_back(path + (part.fromEnd ? " end " : " " + std::to_string(part.offset) + ' ') +
                           std::to_string(part.size));
        const auto found = files.find(path);
        if (found == files.end()) return std::optional<FileContents>();
        return std::optional(FileContents::copyOf(found->second).partialContents(part));
    };
    const Box box{{0, 0, 0, 0}, {5, 2, 0, 0}}, region{{2, 0, 0, 0}, {5, 1, 0, 0}};
    const auto field = readZarr(folder, {.box = box, .region = region});
    ASSERT_TRUE(field) << field.error().message;
    const auto samples = field->samples.values();
    EXPECT_EQ(std::vector(samples.begin(), samples.end()), (std::vector<float>{2, 3, 0, 1, 12, 13, 10, 11}));
    EXPECT_EQ(read, (std::vector<std::string>{"c/0/0 end 68", "c/0/0 8 8", "c/0/0 24 8", "c/0/1 end 68", "c/0/1 0 8",
                                              "c/0/1 16 8"}));
}

TEST(ZarrShards, RefusesDamagedShards) {
    const std::string shard = shardOf({{0, std::string(80, 'x')}}, false);
    std::string otherIndex = shard;
    otherIndex[80 + 16] = 'x';  // the index now states a place for the second chunk, which is not in the shard
    const std::map<std::string, std::string> shards{
        {"'c/0/0' is damaged: it is shorter than its index", shard.substr(0, 60)},
        {"'c/0/0' is damaged: the checksum", otherIndex},
        {"'c/0/0' is damaged: its index states a place beyond its end", shard.substr(80)},
        {"the chunk 0 in the shard 'c/0/0' has 80 bytes; it must have 8", shard}};
    for (const auto& [message, bytes] : shards) {
        const auto field = readFiles({{"zarr.json", shardedArray("end")}, {"c/0/0", bytes}});
        ASSERT_FALSE(field) << message;
        EXPECT_EQ(field.error().code, ErrorCode::bad_field);
        EXPECT_NE(field.error().message.find(message), std::string::npos) << field.error().message;
    }
}

}  // namespace
}  // namespace oval4d::fields::test
