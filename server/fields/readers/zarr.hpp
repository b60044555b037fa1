#pragma once
// A reader of Zarr folders, versions 2 and 3 (zarr-specs.readthedocs.io).

#include <array>
#include <string_view>

#include "errors/error.hpp"
#include "fields/readers/field_array.hpp"
#include "fields/readers/folder_files.hpp"

namespace oval4d::fields {

/// The names of files by which a Zarr folder is recognized. Each Zarr folder contains at least one of these files.
inline constexpr std::array<std::string_view, 3> kZarrFiles{"zarr.json", ".zarray", ".zgroup"};

/// Reads an array from a Zarr folder, or the part of the array in `options.region`. Reads only the chunks that have
/// samples of the part; of a shard, reads the index and these chunks. Types: Booleans, integers and floats of either
/// byte order. Chunks may be parts of shards, be compressed by gzip, zlib, zstd or Blosc, and be in C or Fortran order.
/// In missing chunks, all numbers are the fill value.
///
/// `options.variable` is the path of the array in the folder. Without this option:
///
/// - If the folder is an array, reads this array.
/// - If the folder is a multiscale image (OME-Zarr), reads the level `options.level`. If no level is given, reads the
///   finest level of which the part has at most `options.maxInMemory` and `options.maxInFirstLevel` samples, or else
///   the coarsest level.
/// - If the folder is another group, reads the array with the most dimensions. The consolidated metadata of the group
///   must list its arrays.
///
/// The axes are those in `options.axes` or, without this option, those that the names of the dimensions state (xarray,
/// OME-Zarr). Arrays of coordinates next to the array, or the scales of a multiscale image, give the box. CF attributes
/// such as `units` and `scale_factor` apply. If an array has more than 4 dimensions, dimensions of size 1 are left out
/// until 4 remain.
///
/// Errors: `bad_field` if the metadata are not valid, or if a chunk is damaged or does not have the stated size;
/// `not_found` if there is no array at `options.variable`, or no level `options.level`; `out_of_range` if a group does
/// not list its arrays, if `options.axes` does not fit the array, or if the region lies beyond the box;
/// `unsupported_format` for other types, compressors and filters; `too_large` if there are too many samples, for
/// example more than `options.maxInMemory` in the level `options.level`; and those of `folder`.
Result<FieldArray> readZarr(const FolderFileReader& folder, const FieldReadOptions& options);

}  // namespace oval4d::fields
