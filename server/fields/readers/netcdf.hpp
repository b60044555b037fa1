#pragma once
// A reader of NetCDF files.

#include <cstddef>
#include <span>

#include "errors/error.hpp"
#include "fields/readers/field_array.hpp"
#include "fields/readers/file_contents.hpp"

namespace oval4d::fields {

/// Returns whether the bytes are the start of a NetCDF file in the classic, 64-bit offset or 64-bit data format.
/// Returns false for NetCDF-4 files, which are HDF5 files: readHdf5() recognizes them and passes them to readNetcdf().
bool isNetcdfStart(std::span<const std::byte> start);

/// Reads a variable of integers or real numbers with 1 to 4 dimensions. `options.variable` is the path of the variable,
/// such as "pressure" or "group/pressure". Without this option, reads the variable with the most dimensions, apart from
/// coordinate variables and their bounds. Of several such variables, reads the first; variables of outer groups come
/// before those of inner groups.
///
/// Follows the CF conventions 1.10. The attributes `axis`, `standard_name`, `units` and `positive` of a dimension's
/// coordinate variable determine the axis of the dimension; without them, the dimension's name does. The first and the
/// last coordinate give the box; if the coordinates decrease, the array is reversed. Coordinates that are not evenly
/// spaced are treated as if they were, with a warning. An axis of n samples without coordinates extends from 0 to n −
/// 1; if no axis has coordinates, the box is defaultBox().
///
/// A sample is NaN if its stored number equals `missing_value` or `_FillValue` (by default, NetCDF's fill value for the
/// type), is less than `valid_min` or greater than `valid_max`, or lies outside `valid_range`. `scale_factor` and
/// `add_offset` are applied.
///
/// Errors: `bad_field`, `too_large`; `not_found` if there is no variable at the path `options.variable`; `out_of_range`
/// if `options.axes` does not fit the variable. The NetCDF library is neither thread-safe nor safe for hostile files:
/// files from strangers should be read in a confined process.
Result<FieldArray> readNetcdf(const FileContents& file, const FieldReadOptions& options);

}  // namespace oval4d::fields
