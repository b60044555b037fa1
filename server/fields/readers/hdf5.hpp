#pragma once
// A reader of HDF5 files.

#include <cstddef>
#include <span>

#include "errors/error.hpp"
#include "fields/readers/field_array.hpp"
#include "fields/readers/file_contents.hpp"

namespace oval4d::fields {

/// Returns whether the bytes are the start of an HDF5 file. NetCDF-4 files are HDF5 files, too.
bool isHdf5Start(std::span<const std::byte> start);

/// Reads a dataset of integers, real numbers, or Booleans as h5py writes them, with 1 to 4 dimensions (see
/// squeezedDimensionIndices()). `options.variable` is the path of the dataset, which may contain soft links. Without
/// this option, reads the dataset with the most dimensions, the first by path of several such datasets. A dataset that
/// is stored in one piece is used in place or converted as in readNpy(), without the HDF5 library; other datasets are
/// read by slabs. The box is that of the options, or defaultBox(). NetCDF-4 files are passed to readNetcdf().
///
/// Does not accept files that refer to other files by external links, external storage or virtual datasets. Loads no
/// plug-ins. Errors: `bad_field`, `too_large`; `not_found` if there is no dataset at the path `options.variable`;
/// `out_of_range` if `options.axes` does not fit the dataset.
///
/// The HDF5 library is not safe for hostile files: files from strangers should be read in a confined process.
/// Thread-safe only if the HDF5 library is thread-safe.
Result<FieldArray> readHdf5(const FileContents& file, const FieldReadOptions& options);

}  // namespace oval4d::fields
