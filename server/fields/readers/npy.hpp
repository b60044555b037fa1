#pragma once
// A reader of NumPy's .npy files.

#include <cstddef>
#include <span>

#include "errors/error.hpp"
#include "fields/readers/field_array.hpp"
#include "fields/readers/file_contents.hpp"

namespace oval4d::fields {

/// Returns whether the bytes are the start of a .npy file.
bool isNpyStart(std::span<const std::byte> start);

/// Reads a .npy file of version 1, 2 or 3 (numpy.lib.format). The array must have 1 to 4 dimensions of Booleans,
/// integers of 1 to 8 bytes or floats of 2 to 8 bytes, in either byte order, in C or Fortran order. Uses 32-bit floats
/// in this processor's byte order in place, without a copy, if they are aligned and in the order of Lattice (x varies
/// fastest, w slowest). Converts other arrays. The box is that of the options, or defaultBox(). Errors: `bad_field`,
/// `too_large`; `out_of_range` if the options do not fit the array.
Result<FieldArray> readNpy(const FileContents& file, const FieldReadOptions& options);

}  // namespace oval4d::fields
