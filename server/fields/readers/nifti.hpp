#pragma once
// A reader of NIfTI files, in which many medical images are stored.

#include <cstddef>
#include <span>

#include "errors/error.hpp"
#include "fields/readers/field_array.hpp"
#include "fields/readers/file_contents.hpp"

namespace oval4d::fields {

/// Returns whether the bytes are the start of a NIfTI file. Returns false if there are fewer than 348 bytes.
bool isNiftiStart(std::span<const std::byte> start);

/// Reads a NIfTI-1 or NIfTI-2 file (.nii, .nii.gz) with 1 to 4 dimensions of integers or real numbers, in either byte
/// order. Does not accept images whose header and data are in two files (.hdr, .img). If `options.box` is set, it is
/// the box. Otherwise, the box along the first three dimensions depends on `options.axes`:
///
/// - If `options.axes` is empty and the voxels' axes are parallel to the axes of space, the file's orientation gives
///   the box.
/// - Otherwise, the box is centered at the origin, with the file's distances between samples. If `options.axes` is
///   empty and the voxels' axes are oblique, there is also a warning.
///
/// Along the fourth dimension, the box begins at the time offset that the file states. Errors: `bad_field`,
/// `too_large`; `out_of_range` if the options do not fit the file.
Result<FieldArray> readNifti(const FileContents& file, const FieldReadOptions& options);

}  // namespace oval4d::fields
