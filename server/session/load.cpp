#include "session/load.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>
#include <variant>
#include <vector>

#include <sodium.h>

#include "fields/array_field.hpp"
#include "fields/formula_field.hpp"
#include "fields/readers/field_reader.hpp"
#include "geometry/centering.hpp"
#include "geometry/index.hpp"
#include "geometry/point_cloud.hpp"
#include "geometry/surface_mesh.hpp"
#include "polytopes/catalogue/catalogue.hpp"
#include "polytopes/import/import.hpp"
#include "polytopes/import/off4.hpp"
#include "session/example_fields.hpp"
#include "text/message_text.hpp"
#include "text_files/file_error.hpp"
#include "text_files/plain_text.hpp"
#include "text_files/point_table.hpp"
#include "text_files/tokenizer.hpp"

namespace oval4d::session {

using text_files::FileError;

namespace {

constexpr std::size_t kMaxName = 64;  // maximum length of an object's name, in characters

bool isControl(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }

// Returns the number of characters of a UTF-8 text.
std::size_t characterCount(std::string_view text) {
    constexpr unsigned kContinuation = 0x80, kMask = 0xC0;
    return static_cast<std::size_t>(
        std::ranges::count_if(text, [](char c) { return (static_cast<unsigned>(c) & kMask) != kContinuation; }));
}

// Returns the first `count` characters of a UTF-8 text, or the whole text if it is shorter.
std::string firstCharacters(std::string_view text, std::size_t count) {
    std::size_t end = 0;
    for (std::size_t length = 0; end < text.size(); ++end) {
        length += characterCount(text.substr(end, 1));
        if (length > count) break;
    }
    return std::string(text.substr(0, end));
}

bool isCloudKeyword(std::string_view word) { return text::normalizedName(word) == "cloud"; }

Error errorOf(const FileError& error) {
    return {error.tooLarge ? ErrorCode::too_large : ErrorCode::bad_polytope, text_files::fileErrorText(error)};
}

// Appends a warning if the object was far from the origin of its file, so that another point became its origin.
void warnOfNewOrigin(const geometry::Centering& wanted, const glm::dvec4& originInFile,
                     std::vector<std::string>& warnings) {
    if (wanted.choice != geometry::Centering::OriginChoice::automatic || originInFile == glm::dvec4(0)) return;
    std::string center;
    for (int axis = 0; axis < 4; ++axis) center += (axis == 0 ? "" : ", ") + text::roundedDecimal(originInFile[axis]);
    warnings.push_back("the object is far from the origin: it turns about its center, (" + center +
                       "), where the middle of the slices is, too; the option center=origin keeps the origin");
}

polytopes::ImportLimits importLimits(const Limits& limits) { return {limits.maxVertices, limits.maxHullCells}; }

Result<ObjectWithWarnings> objectFromImport(std::variant<polytopes::ImportedPolytope, FileError> imported,
                                            const LoadObject& load) {
    if (const auto* error = std::get_if<FileError>(&imported)) return errorOf(*error);
    auto& [polytope, warnings] = std::get<polytopes::ImportedPolytope>(imported);
    warnOfNewOrigin(load.center, polytope.originInFile, warnings);
    return ObjectWithWarnings{std::make_shared<const polytopes::Polytope>(std::move(polytope)), std::move(warnings)};
}

// Removes the vertices that no 2-face uses, and returns how many were removed.
std::size_t removeUnusedVertices(std::vector<glm::dvec4>& vertices, geometry::JaggedArray& faces) {
    std::vector<std::uint32_t> number(vertices.size(), geometry::kNone);
    for (const std::uint32_t v : faces.items) number[v] = 0;
    std::uint32_t kept = 0;
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        if (number[v] == geometry::kNone) continue;
        vertices[kept] = vertices[v];
        number[v] = kept++;
    }
    for (std::uint32_t& v : faces.items) v = number[v];
    const std::size_t removed = vertices.size() - kept;
    vertices.resize(kept);
    return removed;
}

// Reads a surface from a 4OFF file without cells. Throws a FileError if the file is invalid or too large.
ObjectWithWarnings readSurface(std::string_view text, const LoadObject& load, const Limits& limits) {
    auto [soup, edges, shortRecord] = polytopes::readOff4(text, limits.maxVertices);
    if (soup.faces.size() == 0)
        text_files::throwFileError(
            0, "the file lists neither 2-faces nor cells; its points can be loaded as a list of points");
    std::vector<std::string> warnings;
    if (const std::size_t removed = removeUnusedVertices(soup.vertices, soup.faces); removed > 0)
        warnings.push_back(std::to_string(removed) + (removed == 1 ? " vertex lies on no 2-face and was left out"
                                                                   : " vertices lie on no 2-face and were left out"));
    const glm::dvec4 center = geometry::newOriginFor(load.center, soup.vertices);
    for (glm::dvec4& vertex : soup.vertices) vertex -= center;
    try {
        auto surface = geometry::makeSurfaceMesh(load.name, std::move(soup.vertices), std::move(soup.faces));
        surface.originInFile = center;
        if (edges != 0 && edges != surface.edges.size())
            warnings.push_back("the file states " + std::to_string(edges) + " edges, but its 2-faces have " +
                               std::to_string(surface.edges.size()));
        warnOfNewOrigin(load.center, center, warnings);
        return {std::make_shared<const geometry::SurfaceMesh>(std::move(surface)), std::move(warnings)};
    } catch (const geometry::InvalidSurface& invalid) {
        if (shortRecord) throw FileError(*shortRecord);
        const bool known = invalid.face != geometry::kNone;
        throw FileError{known ? soup.faceSourcePositions[invalid.face].line : 0, invalid.what()};
    }
}

// Reads a 4OFF file: a polytope, or a surface if the file lists no cells.
Result<ObjectWithWarnings> readOff(const LoadObject& load, const Limits& limits) {
    try {
        const std::string text = text_files::decodePlainText(load.data);
        if (!polytopes::listsCells(text)) return readSurface(text, load, limits);
        return objectFromImport(polytopes::importPlainText(polytopes::PolytopeFileFormat::off4, text, load.name,
                                                           importLimits(limits), load.center),
                                load);
    } catch (const FileError& error) {
        return errorOf(error);
    }
}

// Reads a list of points, and returns their convex hull.
Result<ObjectWithWarnings> readHull(const LoadObject& load, const Limits& limits) {
    return objectFromImport(polytopes::importPolytope(polytopes::PolytopeFileFormat::points, load.data, load.name,
                                                      importLimits(limits), load.center),
                            load);
}

// Reads a point cloud: an optional keyword CLOUD, then a table of points with optional radii.
Result<ObjectWithWarnings> readCloud(const LoadObject& load, const Limits& limits) {
    std::vector<glm::dvec4> points;
    std::vector<double> radii;
    const auto add = [&](const text_files::PointRow& row) {
        points.push_back(row.point);
        radii.push_back(row.radius);
    };
    try {
        std::string text = text_files::decodePlainText(load.data);
        // Replace the keyword by blanks, but keep the comments above it: they may name the columns of the table.
        if (const std::string_view word = text_files::Tokenizer(text).nextWord(); isCloudKeyword(word))
            text.replace(static_cast<std::size_t>(word.data() - text.data()), word.size(), word.size(), ' ');
        auto warnings = text_files::readPoints(text, {.maxPoints = limits.maxVertices, .radii = true}, add);
        const glm::dvec4 center = geometry::newOriginFor(load.center, points);
        for (glm::dvec4& point : points) point -= center;
        auto cloud = geometry::makePointCloud(load.name, std::move(points), std::move(radii));
        cloud.originInFile = center;
        warnOfNewOrigin(load.center, center, warnings);
        return ObjectWithWarnings{std::make_shared<const geometry::PointCloud>(std::move(cloud)), std::move(warnings)};
    } catch (const FileError& error) {
        return errorOf(error);
    } catch (const std::invalid_argument& invalid) {
        return Error{ErrorCode::bad_polytope, invalid.what()};
    }
}

Result<ObjectWithWarnings> readFormulaText(const LoadObject& load, const Limits& /*limits*/) {
    return readFormula(load);
}

// Returns the bytes of the file that `load` specifies: the file `load.file`, or `load.data` decoded from Base64.
Result<fields::FileContents> fileContentsOf(const LoadObject& load) {
    if (load.file) return fields::FileContents::map(load.file->descriptor());
    const std::string& text = load.data;
    std::vector<std::byte> bytes(text.size() / 4 * 3 + 3);
    std::size_t size = 0;
    const char* end = nullptr;
    if (sodium_base642bin(reinterpret_cast<unsigned char*>(bytes.data()), bytes.size(), text.data(), text.size(),
                          " \t\r\n", &size, &end, sodium_base64_VARIANT_ORIGINAL) != 0 ||
        end != text.data() + text.size()) {
        return Error{ErrorCode::bad_field, "the data are not Base64 (RFC 4648, with padding)"};
    }
    bytes.resize(size);
    return fields::FileContents::ofBytes(std::move(bytes));
}

Result<ObjectWithWarnings> readArrayFile(const LoadObject& load, const Limits& limits) {
    const auto file = fileContentsOf(load);
    if (!file) return file.error();
    return readArray(*file, load.name, fieldReadOptionsFor(load, limits), {load.secondFormula, load.secondVariable});
}

// Returns an error if a maximum of the box is less than the minimum. The error message calls the box `name`.
std::optional<Error> checkBoxEndsOrder(const fields::Box& box, std::string_view name) {
    for (int axis = 0; axis < 4; ++axis) {
        if (box.min[axis] <= box.max[axis]) continue;
        return Error{ErrorCode::out_of_range, "the ends of the " + std::string(name) + " along " + "xyzw"[axis] +
                                                  " are in the wrong order: the smaller one comes first"};
    }
    return {};
}

// Returns the error of checkBoxEndsOrder(), or an error if the box has no extent along an axis with several samples.
std::optional<Error> checkBox(const fields::Box& box, const fields::Shape& shape) {
    if (auto error = checkBoxEndsOrder(box, "box")) return error;
    for (int axis = 0; axis < 4; ++axis) {
        const bool wide = shape.at(static_cast<std::size_t>(axis)) > 1;
        if (wide && box.min[axis] == box.max[axis])
            return Error{ErrorCode::out_of_range, std::string("the box has no extent along ") + "xyzw"[axis]};
    }
    return {};
}

// Returns a warning for each axis along which the box of a formula is so far from 0 that the surfaces get steps.
// Functions take coordinates as 32-bit floats, and the distance between neighboring floats grows with their magnitude.
std::vector<std::string> coordinateRoundingWarnings(const fields::Box& box) {
    // The least number of neighboring floats in the box's range along an axis for which there is no warning.
    constexpr double kFewestFloats = 1000;
    std::vector<std::string> warnings;
    for (int axis = 0; axis < 4; ++axis) {
        const auto farthest = static_cast<float>(std::max(std::abs(box.min[axis]), std::abs(box.max[axis])));
        const double step = std::nextafter(farthest, std::numeric_limits<float>::infinity()) - farthest;
        if (box.max[axis] - box.min[axis] >= kFewestFloats * step) continue;
        const std::string name(1, "xyzw"[axis]);
        warnings.push_back("the box is far from 0 along " + name + ": " + name + " is rounded to multiples of " +
                           text::roundedDecimal(step) + ", so surfaces have steps; a box around 0 has none, with " +
                           name + " + " + text::roundedDecimal(box.center()[axis]) + " in place of " + name +
                           " in the formula");
    }
    return warnings;
}

// Makes a field from the array that `read` returns for `options`, and sets the field's second function.
template <typename Read>
Result<ObjectWithWarnings> makeFieldFrom(const Read& read, const std::string& name, fields::FieldReadOptions options,
                                         const SecondFunctionSource& second) {
    if (auto error = options.region ? checkBoxEndsOrder(*options.region, "region") : std::nullopt)
        return std::move(*error);
    Result<fields::FieldArray> array = read(options);
    if (!array) return array.error();
    if (options.box) array->units = {};  // the units in the file apply to the file's box only
    if (auto error = options.box ? checkBox(*options.box, array->shape) : std::nullopt) return std::move(*error);
    auto field = fields::fieldFromArray(name, *array);
    if (!field) return field.error();
    std::optional<Error> fault;
    if (!second.formula.empty()) fault = fields::setSecondFormula(*field, second.formula);
    if (!second.variable.empty()) {
        options.variable = second.variable;
        const std::size_t count = fields::sampleCount(array->shape);
        if (!options.newFile) options.maxSamples -= std::min(options.maxSamples, count);
        if (count <= options.maxInMemory) options.maxInMemory -= count;
        const Result<fields::FieldArray> values = read(options);
        if (!values) return Error{values.error().code, "values: " + values.error().message};
        fault = fields::setSecondArray(*field, *values, second.variable);
    }
    if (fault) return std::move(*fault);
    std::vector<std::string> warnings = array->warnings;
    if (!field->array->statisticsAreExact())
        warnings.emplace_back("the array is not read as a whole: its range is that of a selection of the samples");
    return ObjectWithWarnings{std::make_shared<const fields::Field>(std::move(*field)), std::move(warnings)};
}

/// A file format, its name in `load` messages, and its reader. Formats of arrays have no rows here: see
/// fields::fieldFormats().
struct LoadFormatRow {
    std::string_view name, title;  ///< `name` is used in messages, and `title` in the texts of errors
    Result<ObjectWithWarnings> (*read)(const LoadObject& load, const Limits& limits);
    bool buildsHull;
};
constexpr auto kFormats = std::to_array<LoadFormatRow>({
    {"off", "off (4OFF)", readOff, false},
    {"points", "points", readHull, true},
    {"cloud", "cloud", readCloud, false},
    {kFormula, kFormula, readFormulaText, false},
});
constexpr LoadFormatRow kArrayFormat{"", "", readArrayFile, false};

const LoadFormatRow* loadFormatNamed(std::string_view name) {
    if (isArrayFormat(name)) return &kArrayFormat;
    const auto row = std::ranges::find(kFormats, name, &LoadFormatRow::name);
    return row == kFormats.end() ? nullptr : &*row;
}

Error unsupportedFormatError(std::string_view format) {
    std::vector<std::string_view> allowed;
    for (const LoadFormatRow& row : kFormats) allowed.push_back(row.title);
    for (const std::string_view name : arrayFormatNames()) allowed.push_back(name);
    return {ErrorCode::unsupported_format, "the format " + text::inQuotes(format) +
                                               " cannot be read; allowed formats: " + text::commaSeparated(allowed)};
}

}  // namespace

Result<ObjectWithWarnings> readObject(const LoadObject& load, const Limits& limits) {
    if (load.file && load.format.empty()) return readArrayFile(load, limits);
    if (!load.series.empty()) {
        std::vector<fields::FileContents> files;
        for (const auto& each : load.series) {
            auto file = fields::FileContents::map(each->descriptor());
            if (!file) return file.error();
            files.push_back(std::move(*file));
        }
        return readSeries(files, load, fieldReadOptionsFor(load, limits));
    }
    const LoadFormatRow* row = loadFormatNamed(load.format);
    return row == nullptr ? Result<ObjectWithWarnings>(unsupportedFormatError(load.format)) : row->read(load, limits);
}

LoadObject loadCommandFor(const std::string& name, const fields::FieldFileSource& source) {
    const auto& [dataName, format, axes, variable, secondFormula, secondVariable, box, region] = source;
    LoadObject load{name, format, {}};
    load.dataName = dataName;
    load.axes = axes;
    load.variable = variable;
    load.secondFormula = secondFormula;
    load.secondVariable = secondVariable;
    load.box = box;
    load.region = region;
    return load;
}

Result<ObjectWithWarnings> readFormula(const LoadObject& load) {
    const fields::Box box = load.box.value_or(fields::kFormulaBox);
    constexpr fields::Shape kAnyNumberOfSamples{2, 2, 2, 2};
    if (auto error = checkBox(box, kAnyNumberOfSamples)) return std::move(*error);
    auto field = fields::fieldFromFormula(load.name, load.data, box, load.secondFormula);
    if (!field) return field.error();
    return ObjectWithWarnings{std::make_shared<const fields::Field>(std::move(*field)),
                              coordinateRoundingWarnings(box)};
}

Result<ObjectWithWarnings> readArray(const fields::FileContents& file, const std::string& name,
                                     const fields::FieldReadOptions& options, const SecondFunctionSource& second) {
    return makeFieldFrom([&](const auto& of) { return fields::readField(file, of); }, name, options, second);
}

Result<ObjectWithWarnings> readZarr(const fields::FolderFileReader& folder, const std::string& name,
                                    const fields::FieldReadOptions& options, const SecondFunctionSource& second) {
    return makeFieldFrom([&](const auto& of) { return fields::readZarr(folder, of); }, name, options, second);
}

fields::FieldReadOptions fieldReadOptionsFor(const LoadObject& load, const Limits& limits,
                                             fields::MappedFileMaker newFile) {
    const std::size_t most = limits.maxFieldBytes / sizeof(float);
    fields::FieldReadOptions options{load.axes, load.box, load.variable, most, most};
    if (newFile) options.maxSamples = fields::kMaxSamples;
    options.newFile = std::move(newFile);
    options.region = load.region;
    // If there is a second array, no coarser level is shown first, because a second array has only one level.
    if (load.secondVariable.empty()) options.maxInFirstLevel = limits.maxFirstLevelBytes / sizeof(float);
    if (load.finer) options.level = load.finer->level;
    return options;
}

Result<ObjectWithWarnings> readSeries(std::span<const fields::FileContents> files, const LoadObject& load,
                                      const fields::FieldReadOptions& options) {
    return makeFieldFrom([&](const auto& of) { return fields::readSeries(files, of); }, load.name, options,
                         {load.secondFormula, load.secondVariable});
}

std::string_view detectTextFormat(std::string_view text) {
    try {
        const std::string plain = text_files::decodePlainText(text);
        if (polytopes::detectFileFormat(plain) == polytopes::PolytopeFileFormat::off4) return "off";
        return isCloudKeyword(text_files::Tokenizer(plain).nextWord()) ? "cloud" : "points";
    } catch (const FileError&) {
        return "points";  // readObject() then reads the text as points and reports the fault
    }
}

std::string objectNameFor(std::string_view fileName, const Limits& limits) {
    constexpr std::string_view kSuffix = " (file)";
    std::string name = firstCharacters(text::printable(fileName, fileName.size()), kMaxName);
    if (name.empty()) name = "object";
    const bool taken = exampleNamed(name) != nullptr || std::holds_alternative<polytopes::PolytopeDesign>(
                                                            polytopes::designNamed(name, limits.maxVertices));
    if (taken) name = firstCharacters(name, kMaxName - kSuffix.size()).append(kSuffix);
    return name;
}

std::optional<Error> checkLoad(const LoadObject& load, const Limits& limits) {
    if (load.name.empty() || !text::isUtf8(load.name) || characterCount(load.name) > kMaxName ||
        std::ranges::any_of(load.name, isControl)) {
        return Error{ErrorCode::bad_message, "the name of an object must have 1 to 64 printable characters"};
    }
    if (std::holds_alternative<polytopes::PolytopeDesign>(polytopes::designNamed(load.name, limits.maxVertices))) {
        return Error{ErrorCode::bad_polytope,
                     text::inQuotes(load.name) + " is a name of the catalogue; choose another"};
    }
    // A Zarr folder is recognized by its files, whatever format the command names.
    constexpr std::string_view kZarr = "zarr";
    const bool detected = load.isArrayInFiles() && (load.format.empty() || load.format == kZarr);
    if (!detected && loadFormatNamed(load.format) == nullptr) return unsupportedFormatError(load.format);
    const bool array = detected || isArrayFormat(load.format);
    const auto refused = [&](const std::string& what) {
        return Error{ErrorCode::bad_message, what + ", not the format " + text::inQuotes(load.format)};
    };
    if (load.isArrayInFiles() && !array) return Error{ErrorCode::unsupported_format, "this file must be an array"};
    if (load.box && !array && load.format != kFormula) return refused("only formulas and arrays take a box");
    if (load.region && load.dataName.empty())
        return Error{ErrorCode::bad_message, "only arrays of the data folder (path) have regions"};
    if ((!load.axes.empty() || !load.variable.empty()) && !array) return refused("only arrays take axes or a variable");
    if (!load.secondFormula.empty() && !array && load.format != kFormula)
        return refused("only formulas and arrays take the formula of values");
    if (!load.secondVariable.empty() && !array) return refused("only arrays take a variable of values");
    if (!load.secondFormula.empty() && !load.secondVariable.empty())
        return Error{ErrorCode::bad_message, "give either the formula of the values or their variable, not both"};
    if (load.center != geometry::Centering{} && (array || load.format == kFormula))
        return refused("only polytopes, surfaces and points take a center");
    if (load.append && !load.secondFormula.empty())
        return Error{ErrorCode::bad_message, "moments have no formula of values: that of the field remains"};
    if (load.append && !array) return refused("only arrays can be added to a field");
    return {};
}

bool isArrayFormat(std::string_view format) {
    return std::ranges::any_of(fields::fieldFormats(), [&](const auto& each) { return each.name == format; });
}

std::vector<std::string_view> arrayFormatNames() {
    std::vector<std::string_view> names;
    for (const fields::FieldFileFormat& format : fields::fieldFormats()) names.push_back(format.name);
    return names;
}

bool buildsHull(std::string_view format) {
    const LoadFormatRow* row = loadFormatNamed(format);
    return row != nullptr && row->buildsHull;
}

}  // namespace oval4d::session
