#pragma once
// The metadata of Zarr arrays and groups, versions 2 and 3.

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "errors/error.hpp"
#include "fields/readers/chunk_codecs.hpp"
#include "fields/readers/numbers.hpp"
#include "fields/readers/zarr_shards.hpp"

namespace oval4d::fields {

/// A function that returns the text of the file at `path`, relative to the Zarr folder. Returns an empty optional if
/// there is no such file.
using FolderTextReader = std::function<Result<std::optional<std::string>>(const std::string& path)>;

/// The metadata of an array in a Zarr folder.
struct ZarrArrayMetadata {
    std::string path;  ///< the path of the array's folder, relative to the Zarr folder; empty for the Zarr folder
                       ///< itself
    std::vector<std::size_t> shape, chunk;    ///< the sizes of the array and of its chunks, in the order of its indices
    std::vector<std::size_t> order;           ///< the indices of the dimensions in the order of storage, from the
                                              ///< slowest to the fastest
    StoredNumberFormat format;                ///< the type, and the scale, offset and missing values of the CF
                                              ///< attributes
    std::optional<ChunkCodec> codec;          ///< the compression of chunks; empty if there is none
    std::optional<ShardLayout> shards;        ///< how chunks lie in shards; empty if each chunk is a file
    double fill;                              ///< the value of missing chunks, as a stored number; NaN if the metadata
                                              ///< state none
    std::vector<std::string> dimensionNames;  ///< the name of each dimension; empty if the dimensions have no names
    std::string chunkPrefix, separator;       ///< a chunk's name is the prefix, then its indices with separators
                                              ///< between them

    nlohmann::json attributes;

    /// Returns the value of an attribute that is a string; an empty string if there is none.
    std::string stringAttribute(std::string_view attribute) const;
    /// Returns the path, relative to the Zarr folder, of the chunk or shard with these indices.
    std::string chunkPath(const std::vector<std::size_t>& indices) const;
    /// Returns the size of a decompressed chunk in bytes.
    std::size_t decompressedChunkBytes() const;
};

/// The coordinates of the samples of a level of a multiscale image. For each dimension: its name, its unit, the
/// coordinate of the first sample, and the distance between samples.
struct ZarrCoordinates {
    struct DimensionCoordinates {
        std::string name, unit;
        double origin = 0, spacing = 1;
    };
    std::vector<DimensionCoordinates> dimensions;
};

/// A Zarr folder, which is an array or a group.
class ZarrFolder {
  public:
    explicit ZarrFolder(FolderTextReader read) : read_(std::move(read)) {}

    /// Returns the metadata of an array. Returns an empty optional if there is no array at this path. Errors:
    /// `bad_field`, `unsupported_format`, `too_large`; `out_of_range` if the path leads out of the folder.
    Result<std::optional<ZarrArrayMetadata>> array(const std::string& path) const;

    /// The array that is read from a group if the user names no array.
    struct DefaultArrayChoice {
        std::string path;
        std::vector<std::string> all;  ///< the paths of all arrays among which `path` was chosen
        bool areLevels = false;        ///< whether `all` are the levels of a multiscale image, with the finest first
    };
    /// Chooses an array of a group (see readZarr()). Errors: `unsupported_format` if the folder is neither an array nor
    /// a group; `out_of_range` if the group does not list its arrays; `bad_field` if none of the arrays can be read.
    Result<DefaultArrayChoice> chooseArray() const;

    /// Returns the coordinates of an array that is a level of a multiscale image. Returns an empty optional if the
    /// folder is not a multiscale image, or the array not one of its levels.
    std::optional<ZarrCoordinates> coordinatesOf(const std::string& path) const;

  private:
    Result<std::optional<nlohmann::json>> json(const std::string& path) const;
    nlohmann::json groupAttributes() const;

    const FolderTextReader read_;
};

}  // namespace oval4d::fields
