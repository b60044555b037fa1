#pragma once
// Reads fields from files of all formats, and from series of files.

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "errors/error.hpp"
#include "fields/readers/field_array.hpp"
#include "fields/readers/file_contents.hpp"

namespace oval4d::fields {

/// A format of files that contain fields. The functions have no side effects, except on the state of the libraries that
/// they call.
struct FieldFileFormat {
    std::string_view name;                              ///< the name of the format in messages and on the command line
    bool (*isStart)(std::span<const std::byte> start);  ///< returns whether the bytes are the start of a file of this
                                                        ///< format
    Result<FieldArray> (*read)(const FileContents& file, const FieldReadOptions& options);
};

/// The number of bytes at the start of a file from which its format is recognized.
inline constexpr std::size_t kRecognizedBytes = 352;

/// Returns the formats: "npy", "netcdf", "hdf5", "nifti".
std::span<const FieldFileFormat> fieldFormats();

/// Returns the format of a file, or null if the file has none of the formats. `start` must be the first
/// kRecognizedBytes bytes of the file, or the whole file if it is shorter. A gzip file counts as NIfTI, the only format
/// whose files may be compressed as a whole.
const FieldFileFormat* formatOfFile(std::span<const std::byte> start);

/// Reads a file in the format that its first bytes show. Errors: those of FieldFileFormat::read; `unsupported_format`
/// if the file has none of the formats, or if the options have a region.
Result<FieldArray> readField(const FileContents& file, const FieldReadOptions& options);

/// Reads a series of files, each with one time step, as one field. All files must have the same shape, with one sample
/// along w, and the same box in x, y and z. `options.axes` names the axes of each file. The box of the field is:
///
/// - `options.box`, if it is set.
/// - defaultBox(), if the files do not state their boxes.
/// - Otherwise, the box of the files in x, y and z. Let the time of a file be the w at which its box begins. If the
///   times increase from file to file, w extends from the first to the last time, as if they were evenly spaced, or
///   from 0 on if they are far from 0 (see subtractLeastCoordinateIfFar()). If they do not increase, w is the number of
///   the file, from 0 on; unless all times are equal, there is a warning.
///
/// Errors: those of readField(), with the number of the file; `bad_field` if there are no files, or if their shapes or
/// boxes do not meet these conditions; `too_large` if there are more than `options.maxSamples` samples in all.
Result<FieldArray> readSeries(std::span<const FileContents> files, const FieldReadOptions& options);

/// Returns the files in a folder that have one of the formats, sorted by name. Numbers in names are compared by value:
/// t2 comes before t10. Ignores symbolic links, and names that begin with a dot. Error: `not_found` if the folder
/// cannot be read.
Result<std::vector<std::filesystem::path>> seriesFiles(const std::filesystem::path& folder);

}  // namespace oval4d::fields
