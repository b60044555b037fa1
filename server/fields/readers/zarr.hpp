#pragma once
// Reader of Zarr folders, versions 2 and 3 (zarr-specs.readthedocs.io).

#include <array>
#include <string_view>

#include "errors/error.hpp"
#include "fields/readers/field_array.hpp"
#include "fields/readers/folder_files.hpp"

namespace oval4d::fields {

/// A Zarr folder contains at least one of these files.
inline constexpr std::array<std::string_view, 3> kZarrFiles{"zarr.json", ".zarray", ".zgroup"};

/// Reads an array from a Zarr folder, or the part of it in `options.region`, chunk by chunk; reads only the chunks that
/// have samples of the part, and of a shard the index and these chunks. `options.variable` is the path of the array in
/// the folder. If this option is empty, reads the folder itself if it is an array. If the folder is a multiscale image
/// (OME-Zarr), reads the level `options.level` or, without this option, the finest level of which the part has at most
/// `options.maxInMemory` and `options.maxInFirstLevel` samples, or the coarsest level if there is no such level. If the
/// folder is any other group, the group's consolidated metadata must list its arrays, and the array with the most
/// dimensions is read. Types: Booleans, integers and floats of either byte order. Chunks may be parts of shards, be
/// compressed by gzip, zlib, zstd or Blosc, and be in C or Fortran order; in missing chunks, all numbers are the fill
/// value.
///
/// The axes are those in `options.axes` or, if it is empty, those that the names of the dimensions state (xarray,
/// OME-Zarr). The box is given by the arrays of coordinates beside the array, or by the scales of a multiscale image.
/// CF attributes apply: units, scale_factor and so on. From an array with more than 4 dimensions, dimensions of size 1
/// are left out until 4 remain.
///
/// Errors: `bad_field` if the metadata are not valid, or if a chunk is damaged or does not have the stated size;
/// `not_found` if there is no array at `options.variable`, or no level `options.level`; `out_of_range` if a group does
/// not list its arrays, if `options.axes` does not fit the array, or if the region lies beyond the box;
/// `unsupported_format` for other types, compressors and filters; `too_large`, also if `options.level` has more than
/// `options.maxInMemory` samples; and those of `folder`.
Result<FieldArray> readZarr(const FolderFileReader& folder, const FieldReadOptions& options);

}  // namespace oval4d::fields
