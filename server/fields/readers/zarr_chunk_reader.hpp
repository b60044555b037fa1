#pragma once
// Reads a part of a Zarr array, chunk by chunk.

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "errors/error.hpp"
#include "fields/readers/chunk_codecs.hpp"
#include "fields/readers/field_array.hpp"
#include "fields/readers/folder_files.hpp"
#include "fields/readers/numbers.hpp"
#include "fields/readers/zarr_chunk_files.hpp"
#include "fields/readers/zarr_metadata.hpp"

namespace oval4d::fields {

/// A part of an array: for each dimension, the first index and the number of indices.
struct IndexBox {
    std::vector<std::size_t> first, size;
};

/// Reads the chunks of an array that contain numbers of a part of the array.
class ZarrChunkReader {
  public:
    ZarrChunkReader(const FolderFileReader& folder, const ZarrArrayMetadata& array, IndexBox part)
        : chunks_(folder, array), array_(array), part_(std::move(part)) {}

    /// Reads and converts the numbers of the part. `stride` has, for each dimension, the distance in `to` between
    /// neighbors along this dimension; `first` is the place in `to` of the part's first number. Before the call, `to`
    /// must contain only zeros, because missing chunks whose fill value is 0 are skipped. Calls `afterward` about once
    /// per kNumbers numbers, so that the caller can release memory.
    template <typename Afterward>
    Result<std::monostate> read(const std::vector<std::ptrdiff_t>& stride, std::size_t first, float* to,
                                const Afterward& afterward) {
        constexpr std::size_t kNumbers = std::size_t{1} << 24U;  // numbers between two calls of `afterward`
        const std::size_t rank = array_.shape.size();
        // Chunks are read shard by shard, so that the index of each shard is read only once. Without shards, each chunk
        // counts as a shard.
        const Indices perShard = array_.shards ? array_.shards->chunks : Indices(rank, 1);
        Indices begin(rank), end(rank), beginShard(rank), endShard(rank);  // the chunks and the shards of the part
        for (std::size_t i = 0; i < rank; ++i) {
            begin[i] = part_.first[i] / array_.chunk[i];
            end[i] = begin[i] + 1 + (part_.first[i] % array_.chunk[i] + part_.size[i] - 1) / array_.chunk[i];
            beginShard[i] = begin[i] / perShard[i];
            endShard[i] = (end[i] - 1) / perShard[i] + 1;
        }
        std::size_t numbers = 0;
        Indices shard = beginShard, from(rank), until(rank);
        do {
            for (std::size_t i = 0; i < rank; ++i) {
                from[i] = std::max(begin[i], shard[i] * perShard[i]);
                until[i] = std::min(end[i], (shard[i] + 1) * perShard[i]);
            }
            Indices index = from;
            do {
                if (auto chunk = readChunk(index, stride, to + first); !chunk) return chunk;
                numbers += array_.decompressedChunkBytes() / sizeOf(array_.format.type);
                if (numbers >= kNumbers) {
                    afterward();
                    numbers = 0;
                }
            } while (nextIndexInRange(index, from, until));
        } while (nextIndexInRange(shard, beginShard, endShard));
        return std::monostate{};
    }

  private:
    using Indices = std::vector<std::size_t>;

    // Moves `index` to the next place in C order (the last dimension varies fastest). Along each dimension, the places
    // are from `begin` to `end` − 1. After the last place, returns to the first one and returns false.
    static bool nextIndexInRange(Indices& index, const Indices& begin, const Indices& end) {
        for (std::size_t i = index.size(); i-- > 0;) {
            if (++index[i] < end[i]) return true;
            index[i] = begin[i];
        }
        return false;
    }

    Result<std::monostate> readChunk(const std::vector<std::size_t>& index, const std::vector<std::ptrdiff_t>& stride,
                                     float* to) {
        auto file = chunks_.chunkContentsOf(index);
        if (!file) return file.error();
        if (!*file) {
            fillMissingChunk(index, stride, to);
            return std::monostate{};
        }
        std::span<const std::byte> bytes = (*file)->bytes;
        if (array_.codec) {
            chunk_.resize(array_.decompressedChunkBytes());
            if (const auto done = decompress(*array_.codec, bytes, chunk_); !done)
                return badFieldError(chunks_.chunkNameForErrors(index) + " cannot be read: " + done.error().message);
            bytes = chunk_;
        } else if (bytes.size() != array_.decompressedChunkBytes()) {
            return badFieldError(chunks_.chunkNameForErrors(index) + " has " + std::to_string(bytes.size()) +
                                 " bytes; it must have " + std::to_string(array_.decompressedChunkBytes()));
        }
        convertChunk(index, stride, bytes.data(), to);
        if ((*file)->file && (*file)->file->isLost())
            return badFieldError(chunks_.chunkNameForErrors(index) + " was shortened");
        return std::monostate{};
    }

    // A range of indices in a chunk along one dimension: from `begin` to `end` − 1.
    struct IndexRange {
        std::size_t begin, end;
    };

    // Returns the range of indices, along a dimension of the chunk `index`, that are in the part.
    IndexRange partRangeWithinChunk(const std::vector<std::size_t>& index, std::size_t dimension) const {
        const std::size_t chunk = index[dimension] * array_.chunk[dimension], first = part_.first[dimension];
        return {std::max(first, chunk) - chunk,
                std::min(array_.chunk[dimension], first + part_.size[dimension] - chunk)};
    }

    // Converts, row by row, the numbers of the chunk `index` that are in the part. `from` is the decompressed chunk.
    void convertChunk(const std::vector<std::size_t>& index, const std::vector<std::ptrdiff_t>& stride,
                      const std::byte* from, float* to) const {
        const std::size_t size = sizeOf(array_.format.type);
        visitRows(index, stride, [&](std::size_t number, std::ptrdiff_t at, std::size_t count, std::ptrdiff_t step) {
            convertToFloats(array_.format, from + number * size, {{1, 1, 1, count}, {0, 0, 0, step}}, to + at);
        });
    }

    void fillMissingChunk(const std::vector<std::size_t>& index, const std::vector<std::ptrdiff_t>& stride,
                          float* to) const {
        // The fill value is a stored number, so it is converted like all others.
        StoredNumberFormat format = array_.format;
        format.type = NumberType::f8;
        format.bigEndian = std::endian::native == std::endian::big;
        float value = 0;
        convertToFloats(format, reinterpret_cast<const std::byte*>(&array_.fill), {{1, 1, 1, 1}, {0, 0, 0, 0}}, &value);
        if (std::bit_cast<std::uint32_t>(value) == 0) return;  // `to` already contains zeros
        visitRows(index, stride, [&](std::size_t, std::ptrdiff_t at, std::size_t count, std::ptrdiff_t step) {
            for (std::size_t i = 0; i < count; ++i) to[at + static_cast<std::ptrdiff_t>(i) * step] = value;
        });
    }

    // Visits the stored rows of a chunk that have numbers in the part. Calls `visit` for each row with four arguments:
    // - the index, in the chunk, of the first number n of the row that is in the part;
    // - the distance in `to` from the place of the part's first number to the place of n;
    // - how many numbers of the row are in the part;
    // - the distance in `to` between the places of two such numbers that are neighbors.
    template <typename Visit>
    void visitRows(const std::vector<std::size_t>& index, const std::vector<std::ptrdiff_t>& stride,
                   const Visit& visit) const {
        const std::vector<std::size_t>& order = array_.order;
        const std::size_t rank = order.size(), fastest = order.back();
        std::vector<IndexRange> range(rank);
        std::vector<std::size_t> i(rank);  // the indices of a row in the chunk, in the order of storage
        for (std::size_t d = 0; d < rank; ++d) {
            range[d] = partRangeWithinChunk(index, order[d]);
            i[d] = range[d].begin;
        }
        for (;;) {
            std::size_t number = 0;
            std::ptrdiff_t at = 0;
            for (std::size_t d = 0; d < rank; ++d) {
                const std::size_t dimension = order[d];
                number = number * array_.chunk[dimension] + i[d];
                const std::size_t inPart = index[dimension] * array_.chunk[dimension] + i[d] - part_.first[dimension];
                at += static_cast<std::ptrdiff_t>(inPart) * stride[dimension];
            }
            visit(number, at, range.back().end - range.back().begin, stride[fastest]);
            std::size_t d = rank - 1;
            while (d > 0 && ++i[d - 1] == range[d - 1].end) {
                --d;
                i[d] = range[d].begin;
            }
            if (d == 0) return;
        }
    }

    ZarrChunkFiles chunks_;
    const ZarrArrayMetadata& array_;
    const IndexBox part_;
    std::vector<std::byte> chunk_;
};

}  // namespace oval4d::fields
