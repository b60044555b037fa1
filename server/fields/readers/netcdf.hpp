#pragma once
// NetCDF files.

#include <cstddef>
#include <span>

#include "errors/error.hpp"
#include "fields/readers/field_array.hpp"
#include "fields/readers/file_contents.hpp"

namespace oval4d::fields {

/// Returns whether the bytes are the start of a NetCDF file in the format classic, 64-bit offset or 64-bit data.
/// NetCDF-4 files are HDF5 files: readHdf5() recognizes them and passes them to readNetcdf().
bool isNetcdfStart(std::span<const std::byte> start);

/// Reads a variable of integers or real numbers with 1 to 4 dimensions. `options.variable` is its path, such as
/// "pressure" or "group/pressure". If this option is empty, the variable with the most dimensions is read; of several
/// such variables, the first, where the variables of outer groups come before those of inner groups. Coordinate
/// variables and their bounds are not considered.
///
/// Follows the CF conventions 1.10. The axis of a dimension is given by the attributes `axis`, `standard_name`, `units`
/// and `positive` of its coordinate variable, or else by the dimension's name. The first and the last coordinate give
/// the box; if the coordinates decrease, the array is reversed. Coordinates that are not evenly spaced are treated as
/// if they were, with a warning. An axis without coordinates extends from 0 to n − 1 for n samples; if there are no
/// coordinates at all, the box is defaultBox(). A sample is NaN if its stored number equals `missing_value` or
/// `_FillValue` (without this attribute, NetCDF's default for the type), is less than `valid_min` or greater than
/// `valid_max`, or lies outside `valid_range`. `scale_factor` and `add_offset` are applied.
///
/// Errors: `bad_field`, `too_large`, `not_found` for the variable, `out_of_range` for the other options. The library
/// NetCDF is neither thread-safe nor made for hostile files: files from strangers should be read in a confined process.
Result<FieldArray> readNetcdf(const FileContents& file, const FieldReadOptions& options);

}  // namespace oval4d::fields
