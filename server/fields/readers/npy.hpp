#pragma once
// NumPy's .npy format.

#include <cstddef>
#include <span>

#include "errors/error.hpp"
#include "fields/readers/field_array.hpp"
#include "fields/readers/file_contents.hpp"

namespace oval4d::fields {

/// Returns whether the bytes are the start of a .npy file.
bool isNpyStart(std::span<const std::byte> start);

/// Reads a .npy file of version 1, 2 or 3 (numpy.lib.format): an array of Booleans, integers of 1 to 8 bytes or floats
/// of 2 to 8 bytes, with 1 to 4 dimensions (see dimensionsWithAxes()), in either byte order, in C or Fortran order. 32-bit floats in this
/// processor's byte order are used in place, without a copy, if they are aligned and in the order of Lattice (x varies
/// fastest, w slowest); other arrays are converted. The box is that of the options, or defaultBox(). Errors:
/// `bad_field`, `too_large`; `out_of_range` for the options.
Result<FieldArray> readNpy(const FileContents& file, const FieldReadOptions& options);

}  // namespace oval4d::fields
