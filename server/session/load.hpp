#pragma once
// Reads objects from files, and makes fields from formulas.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "errors/error.hpp"
#include "fields/field.hpp"
#include "fields/readers/field_array.hpp"
#include "fields/readers/file_contents.hpp"
#include "fields/readers/zarr.hpp"
#include "session/command.hpp"
#include "session/session.hpp"

namespace oval4d::session {

/// The value of LoadObject::format if LoadObject::data is a formula.
inline constexpr std::string_view kFormula = "formula";

/// An object that was read, and warnings for the user: one for each fault that was corrected in the file, and others,
/// such as that the object was moved to its center.
struct ObjectWithWarnings {
    slicing::Object object;
    std::vector<std::string> warnings;
};

/// Reads the object that `load` specifies, in the calling process (a FileReader of object_loader.hpp may do so in
/// another process). The format is "off", "points", "cloud", "formula", or one of fields::fieldFormats(), the formats
/// of arrays. Files of arrays are given in Base64 or as open files; they may have at most Limits::maxFieldBytes of
/// samples. Ignores `append`, `folder` and `dataName`. Errors: `unsupported_format`, `bad_polytope` (with the line
/// number, if the fault is in a line), `too_large`, and those of readFormula() and readArray().
Result<ObjectWithWarnings> readObject(const LoadObject& load, const Limits& limits);

/// Returns the command that reads a field with this name from its file in the data folder again.
LoadObject loadOf(const std::string& name, const fields::FileSource& source);

/// Makes a field from the formula in `load`. Takes less than a millisecond. Warns if the box is so far from 0 that the
/// surfaces get steps from rounded coordinates. Errors: those of fields::fieldFromFormula().
Result<ObjectWithWarnings> readFormula(const LoadObject& load);

/// The source of the second function of an array: a formula, or another variable of its file. Both are empty if there
/// is no second function.
struct SecondFunctionSource {
    std::string formula, variable;
};

/// Reads an array from a file whose format is one of fields::fieldFormats(). Errors: those of fields::readField(),
/// fields::fieldFromArray(), fields::setSecondArray() and fields::setSecondFormula(); `out_of_range` if the box of the
/// options has no extent along an axis with several samples, or if the ends of the box along any axis are in the wrong
/// order.
Result<ObjectWithWarnings> readArray(const fields::FileContents& file, const std::string& name,
                                     const fields::FieldReadOptions& options = {},
                                     const SecondFunctionSource& second = {});

/// Returns the options for reading the array that `load` specifies. The array and its second array together may have at
/// most Limits::maxFieldBytes. If `newFile` is given, larger arrays are allowed, too: their samples remain in the file
/// or are written to a new file. Of a multiscale image, selects the level `load.finer` or, without it, one of at most
/// Limits::maxFirstLevelBytes.
fields::FieldReadOptions optionsForReading(const LoadObject& load, const Limits& limits,
                                           fields::MappedFileMaker newFile = {});

/// Reads an array, or the region of it that the options select, from a Zarr folder. Errors: those of
/// fields::readZarr(), and of readArray(); `out_of_range` if the ends of the region along any axis are in the wrong
/// order.
Result<ObjectWithWarnings> readZarr(const fields::FolderFileReader& folder, const std::string& name,
                                    const fields::FieldReadOptions& options = {},
                                    const SecondFunctionSource& second = {});

/// Reads the files of a series as one array, with the name and the second function of `load`. Errors: those of
/// fields::readSeries(), and of readArray().
Result<ObjectWithWarnings> readSeries(std::span<const fields::FileContents> files, const LoadObject& load,
                                      const fields::FieldReadOptions& options);

/// Returns the format that the first word of the file `text` shows: "off" if this word contains OFF, as in 4OFF;
/// "cloud" if it is CLOUD; otherwise "points".
std::string_view detectTextFormat(std::string_view text);

/// Checks `load`, but not its data. Returns an empty optional if it is valid, else an error: `bad_message` for a
/// malformed name or for members that the format does not take, `bad_polytope` for a name that already denotes a
/// polytope, or `unsupported_format`.
std::optional<Error> checkLoad(const LoadObject& load, const Limits& limits);

/// Returns a name for the object in the file called `fileName`. checkLoad() accepts this name: long file names are
/// shortened, and characters that are not allowed are replaced. Adds " (file)" to a name of the catalogue or of an
/// example field, because otherwise a stored state would be restored with the catalogue's object or with the example
/// field.
std::string objectNameFor(std::string_view fileName, const Limits& limits);

/// Returns whether the files of this format are arrays.
bool isArrayFormat(std::string_view format);

/// Returns the names of the formats of arrays.
std::vector<std::string_view> arrayFormatNames();

/// Returns whether reading this format includes computing a convex hull, which takes longer than reading a polytope's
/// faces and cells from the file.
bool buildsHull(std::string_view format);

}  // namespace oval4d::session
