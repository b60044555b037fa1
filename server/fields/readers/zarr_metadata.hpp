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

/// Returns the text of a file in the folder by its relative path; an empty optional if there is no such file.
using FolderTextReader = std::function<Result<std::optional<std::string>>(const std::string& path)>;

/// An array in a Zarr folder.
struct ZarrArrayMetadata {
    std::string path;  ///< of the array's folder, relative to the Zarr folder; empty for the Zarr folder itself
    std::vector<std::size_t> shape, chunk;    ///< the sizes of the array and of its chunks, in the order of its indices
    std::vector<std::size_t> order;           ///< the indices of the dimensions as they are stored, from the
                                              ///< slowest to the fastest
    NumberFormat format;                      ///< with scale, offset and missing values as the CF attributes state them
    std::optional<ChunkCodec> codec;          ///< empty if chunks are not compressed
    std::optional<ShardLayout> shards;        ///< empty if each chunk is a file of its own
    double fill;                              ///< the value of missing chunks, as a stored number; NaN if there is none
    std::vector<std::string> dimensionNames;  ///< empty, or one for each dimension
    std::string chunkPrefix, separator;       ///< a chunk's name: the prefix, then its indices with separators between

    nlohmann::json attributes;

    /// Returns the value of an attribute that is a string; an empty string if there is none.
    std::string text(std::string_view attribute) const;
    /// Returns the path of the file, a chunk or a shard, with these indices, relative to the Zarr folder.
    std::string chunkPath(const std::vector<std::size_t>& indices) const;
    /// Returns the size of a decompressed chunk in bytes.
    std::size_t decompressedChunkBytes() const;
};

/// The coordinates of the samples of an array of a multiscale image: for each dimension its name, its unit, the
/// coordinate of the first sample, and the distance between samples.
struct ZarrCoordinates {
    struct DimensionCoordinates {
        std::string name, unit;
        double origin = 0, spacing = 1;
    };
    std::vector<DimensionCoordinates> dimensions;
};

/// A Zarr folder: an array or a group.
class ZarrFolder {
  public:
    explicit ZarrFolder(FolderTextReader read) : read_(std::move(read)) {}

    /// Returns the metadata of an array; an empty optional if there is none at this path. Errors: `bad_field`,
    /// `unsupported_format`, `too_large`; `out_of_range` if the path leads out of the folder.
    Result<std::optional<ZarrArrayMetadata>> array(const std::string& path) const;

    /// The array that is read from a group if the user does not name one.
    struct ChosenArray {
        std::string path;
        std::vector<std::string> all;  ///< the paths of all arrays among which `path` was chosen
        bool areLevels = false;        ///< whether `all` are the levels of a multiscale image, the finest first
    };
    /// Chooses an array to read if the folder is a group (see readZarr()). Errors: `unsupported_format` if the folder
    /// is neither an array nor a group; `out_of_range` if the group does not list its arrays; `bad_field` if none of
    /// them can be read.
    Result<ChosenArray> chooseArray() const;

    /// Returns the coordinates of an array; an empty optional unless the folder is a multiscale image and the array is
    /// one of its levels.
    std::optional<ZarrCoordinates> coordinatesOf(const std::string& path) const;

  private:
    Result<std::optional<nlohmann::json>> json(const std::string& path) const;
    nlohmann::json groupAttributes() const;

    const FolderTextReader read_;
};

}  // namespace oval4d::fields
