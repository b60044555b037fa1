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

/// The value of LoadObject::format for which LoadObject::data is a formula.
inline constexpr std::string_view kFormula = "formula";

/// An object read from a file, and warnings for the user: for example, one for each corrected fault of the file.
struct ObjectWithWarnings {
    slicing::Object object;
    std::vector<std::string> warnings;
};

/// Reads the object that `load` specifies, in the calling process. The format is "off", "points", "cloud", "formula",
/// or a format of arrays (one of fields::fieldFormats()). An array comes in Base64 or as an open file; its samples may
/// take at most Limits::maxFieldBytes of memory. Ignores the members `append`, `folder` and `dataName`. Errors:
/// `unsupported_format`; `bad_polytope`, with the line number if one line is at fault; `too_large`; and the errors of
/// readFormula() and readArray().
Result<ObjectWithWarnings> readObject(const LoadObject& load, const Limits& limits);

/// Returns the command that reads the field `name` again from its file in the server's data folder.
LoadObject loadCommandFor(const std::string& name, const fields::FieldFileSource& source);

/// Makes a field from the formula in `load`. Takes less than a millisecond. Warns if the box is so far from 0 that the
/// surfaces get steps from rounded coordinates. Errors: those of fields::fieldFromFormula().
Result<ObjectWithWarnings> readFormula(const LoadObject& load);

/// The source of an array's second function: a formula, or the name of another variable in the same file. Both members
/// are empty if there is no second function.
struct SecondFunctionSource {
    std::string formula, variable;
};

/// Reads an array from a file whose format is one of fields::fieldFormats(). Errors: the errors of fields::readField(),
/// fields::fieldFromArray(), fields::setSecondArray() and fields::setSecondFormula(); `out_of_range` if the box in the
/// options has no extent along an axis with several samples, or has a maximum less than its minimum.
Result<ObjectWithWarnings> readArray(const fields::FileContents& file, const std::string& name,
                                     const fields::FieldReadOptions& options = {},
                                     const SecondFunctionSource& second = {});

/// Returns the options for reading the array that `load` specifies. The array and its second array together may have at
/// most Limits::maxFieldBytes. If `newFile` is given, larger arrays are allowed: their samples stay in the file, or are
/// written to a file that `newFile` makes. From a multiscale image, the options select the level `load.finer`; without
/// `load.finer`, a level of at most Limits::maxFirstLevelBytes.
fields::FieldReadOptions fieldReadOptionsFor(const LoadObject& load, const Limits& limits,
                                             fields::MappedFileMaker newFile = {});

/// Reads an array, or the region of an array that the options select, from a Zarr folder. Errors: the errors of
/// fields::readZarr() and readArray(); `out_of_range` if the region has a maximum less than its minimum.
Result<ObjectWithWarnings> readZarr(const fields::FolderFileReader& folder, const std::string& name,
                                    const fields::FieldReadOptions& options = {},
                                    const SecondFunctionSource& second = {});

/// Reads the files of a series, one time step each, as one array. The name and the second function come from `load`.
/// Errors: the errors of fields::readSeries() and readArray().
Result<ObjectWithWarnings> readSeries(std::span<const fields::FileContents> files, const LoadObject& load,
                                      const fields::FieldReadOptions& options);

/// Returns the format of the file `text`, judged by its first word: "off" if the word contains OFF, as 4OFF does;
/// "cloud" if the word is CLOUD; otherwise "points".
std::string_view detectTextFormat(std::string_view text);

/// Checks all members of `load` except the data. Returns an empty optional if they are valid. Errors: `bad_message` for
/// a malformed name, or for members that the format does not allow; `bad_polytope` for a name that already denotes a
/// polytope; `unsupported_format`.
std::optional<Error> checkLoad(const LoadObject& load, const Limits& limits);

/// Returns a name that checkLoad() accepts, for the object in the file `fileName`. Long file names are shortened, and
/// forbidden characters are replaced. If the catalogue of polytopes or the example fields contain the name, " (file)"
/// is appended. Otherwise, a stored state would be restored with the object of the catalogue or with the example field.
std::string objectNameFor(std::string_view fileName, const Limits& limits);

/// Returns whether files of the format `format` contain arrays.
bool isArrayFormat(std::string_view format);

/// Returns the names of the formats of arrays.
std::vector<std::string_view> arrayFormatNames();

/// Returns whether the reader of a format computes a convex hull, which takes longer than reading lists of faces and
/// cells.
bool buildsHull(std::string_view format);

}  // namespace oval4d::session
