#include "fields/readers/netcdf.hpp"

#include <netcdf.h>
#include <netcdf_mem.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fields/readers/axis_mapping.hpp"
#include "fields/readers/cf_conventions.hpp"
#include "fields/readers/sample_buffer.hpp"
#include "text/message_text.hpp"

namespace oval4d::fields {

namespace {

constexpr std::size_t kMaxNetcdfText = 64;  // the maximum number of bytes that are kept of a message of the library

// A file that the NetCDF library has opened. The destructor closes the file.
class OpenNetcdfFile {
  public:
    explicit OpenNetcdfFile(const FileContents& file) {
        // The library does not change the bytes, although their type is not const.
        auto* const bytes = const_cast<std::byte*>(file.bytes.data());
        const std::size_t size = file.bytes.size();
        status_ = nc_open_mem("field", NC_NOWRITE, size, bytes, &id_);
        // libnetcdf 4.9 reads the header of a file of the classic format in parts of growing size. If the header takes
        // more than about half of the file, a part would extend beyond the end of the file, and the library fails with
        // EPERM. A small file is then opened again with zeros appended, as many as it has bytes.
        constexpr std::size_t kMostPadded = std::size_t{1} << 20U;
        if (status_ == EPERM && size <= kMostPadded) {
            padded_.assign(file.bytes.begin(), file.bytes.end());
            padded_.resize(2 * size);
            status_ = nc_open_mem("field", NC_NOWRITE, padded_.size(), padded_.data(), &id_);
        }
    }
    ~OpenNetcdfFile() {
        if (status_ == NC_NOERR) nc_close(id_);
    }
    OpenNetcdfFile(const OpenNetcdfFile&) = delete;
    OpenNetcdfFile& operator=(const OpenNetcdfFile&) = delete;

    int status() const { return status_; }
    int id() const { return id_; }

  private:
    std::vector<std::byte> padded_;  // the bytes of the file, followed by zeros; empty if no zeros were needed
    int id_ = -1, status_;
};

struct NetcdfVariable {
    int group = -1, id = -1;
    std::string name;
    nc_type type = NC_NAT;
    std::vector<int> dimensions;
};

std::optional<NetcdfVariable> variableAt(int group, int id) {
    NetcdfVariable variable{group, id, {}, NC_NAT, {}};
    std::array<char, NC_MAX_NAME + 1> name{};
    int count = 0;
    if (nc_inq_var(group, id, name.data(), &variable.type, &count, nullptr, nullptr) != NC_NOERR) return {};
    variable.name = name.data();
    variable.dimensions.resize(static_cast<std::size_t>(count));
    if (nc_inq_vardimid(group, id, variable.dimensions.data()) != NC_NOERR) return {};
    return variable;
}

std::optional<NetcdfVariable> variableNamed(int group, const std::string& name) {
    int id = -1;
    if (nc_inq_varid(group, name.c_str(), &id) != NC_NOERR) return {};
    return variableAt(group, id);
}

std::string dimensionName(int group, int dimension) {
    std::array<char, NC_MAX_NAME + 1> name{};
    return nc_inq_dimname(group, dimension, name.data()) == NC_NOERR ? name.data() : "";
}

// Returns an attribute that is a text, as sanitizeQuantityText() returns it. Returns an empty string if there is no
// such attribute.
std::string attributeText(const NetcdfVariable& variable, const char* attribute) {
    nc_type type = NC_NAT;
    std::size_t length = 0;
    if (nc_inq_att(variable.group, variable.id, attribute, &type, &length) != NC_NOERR || length == 0) return {};
    if (type == NC_STRING) {
        std::vector<char*> strings(length);
        if (nc_get_att_string(variable.group, variable.id, attribute, strings.data()) != NC_NOERR) return {};
        std::string text = strings[0] != nullptr ? sanitizeQuantityText(strings[0]) : "";
        nc_free_string(length, strings.data());
        return text;
    }
    std::string text(length, '\0');
    if (type != NC_CHAR || nc_get_att_text(variable.group, variable.id, attribute, text.data()) != NC_NOERR) return {};
    return sanitizeQuantityText(text.substr(0, text.find('\0')));
}

std::vector<double> attributeNumbers(const NetcdfVariable& variable, const char* attribute) {
    constexpr std::size_t kMaxNumbers = 100;
    nc_type type = NC_NAT;
    std::size_t length = 0;
    if (nc_inq_att(variable.group, variable.id, attribute, &type, &length) != NC_NOERR || type == NC_CHAR ||
        type == NC_STRING || length > kMaxNumbers) {
        return {};
    }
    std::vector<double> numbers(length);
    if (nc_get_att_double(variable.group, variable.id, attribute, numbers.data()) != NC_NOERR) return {};
    return numbers;
}

struct NetcdfTypeRow {
    nc_type type;
    NumberType number;
    double fill;  // the default value of numbers that were never written; kNoFill if the type has no default
};
constexpr double kNoFill = std::numeric_limits<double>::quiet_NaN();
constexpr std::array<NetcdfTypeRow, 10> kNetcdfTypes{{{NC_BYTE, NumberType::i1, kNoFill},
                                                      {NC_UBYTE, NumberType::u1, kNoFill},
                                                      {NC_SHORT, NumberType::i2, NC_FILL_SHORT},
                                                      {NC_USHORT, NumberType::u2, NC_FILL_USHORT},
                                                      {NC_INT, NumberType::i4, NC_FILL_INT},
                                                      {NC_UINT, NumberType::u4, NC_FILL_UINT},
                                                      {NC_INT64, NumberType::i8, static_cast<double>(NC_FILL_INT64)},
                                                      {NC_UINT64, NumberType::u8, static_cast<double>(NC_FILL_UINT64)},
                                                      {NC_FLOAT, NumberType::f4, double{NC_FILL_FLOAT}},
                                                      {NC_DOUBLE, NumberType::f8, NC_FILL_DOUBLE}}};

const NetcdfTypeRow* typeRowOf(nc_type type) {
    const auto* const row = std::find_if(kNetcdfTypes.begin(), kNetcdfTypes.end(),
                                         [&](const NetcdfTypeRow& each) { return each.type == type; });
    return row == kNetcdfTypes.end() ? nullptr : row;
}

StoredNumberFormat netcdfNumberFormatOf(const NetcdfVariable& variable, const NetcdfTypeRow& row) {
    StoredNumberFormat format;
    format.type = row.number;
    format.bigEndian = std::endian::native == std::endian::big;  // the library converts numbers to this processor's
                                                                 // byte order
    format.missing = attributeNumbers(variable, "_FillValue");
    if (format.missing.empty() && !std::isnan(row.fill)) format.missing = {row.fill};
    for (const double number : attributeNumbers(variable, "missing_value")) format.missing.push_back(number);
    std::erase_if(format.missing, [](double number) { return std::isnan(number); });  // NaN is always a missing sample
    const auto first = [&](const char* attribute, double otherwise) {
        const auto numbers = attributeNumbers(variable, attribute);
        return numbers.size() == 1 ? numbers[0] : otherwise;
    };
    format.min = first("valid_min", format.min);
    format.max = first("valid_max", format.max);
    if (const auto range = attributeNumbers(variable, "valid_range"); range.size() == 2) {
        format.min = range[0];
        format.max = range[1];
    }
    format.roundLimitsToType();
    format.scale = first("scale_factor", 1);
    format.offset = first("add_offset", 0);
    return format;
}

// Returns the coordinate variable of a dimension of `variable`: the variable that has the name of the dimension, and
// has only this dimension. The coordinate variable may be in the group of `variable` or in an outer group. The name
// alone does not identify the coordinate variable: a variable may be named like a dimension that it does not have, and
// a dimension of a group may be named like a dimension of an outer group.
std::optional<NetcdfVariable> coordinateVariableOf(const NetcdfVariable& variable, int dimension) {
    const std::string name = dimensionName(variable.group, dimension);
    int group = variable.group;
    do {
        auto found = variableNamed(group, name);
        if (found && found->dimensions == std::vector{dimension}) return found;
    } while (nc_inq_grp_parent(group, &group) == NC_NOERR);
    return {};
}

// Returns the name and the attributes of a dimension of `variable` that the file states.
CfDimension describeDimension(const NetcdfVariable& variable, int dimension) {
    CfDimension stated{dimensionName(variable.group, dimension), {}, {}, {}, {}};
    if (const auto coordinate = coordinateVariableOf(variable, dimension)) {
        stated.axis = attributeText(*coordinate, "axis");
        stated.standardName = attributeText(*coordinate, "standard_name");
        stated.units = attributeText(*coordinate, "units");
        stated.positive = attributeText(*coordinate, "positive");
    }
    return stated;
}

// Returns the indices of the dimensions of a variable that become axes. If there are more than four dimensions, leaves
// out dimensions of size 1 until four remain: first those that are no axes of space or time, such as the dimension for
// the only member of an ensemble.
std::vector<std::size_t> dimensionsAfterSqueeze(const NetcdfVariable& variable) {
    std::vector<std::size_t> kept(variable.dimensions.size());
    std::iota(kept.begin(), kept.end(), std::size_t{0});
    for (const bool axesToo : {false, true}) {
        for (std::size_t i = 0; i < kept.size() && kept.size() > 4;) {
            const int dimension = variable.dimensions[kept[i]];
            std::size_t size = 0;
            const bool isSingle = nc_inq_dimlen(variable.group, dimension, &size) == NC_NOERR && size == 1;
            if (isSingle && (axesToo || !cfAxis(describeDimension(variable, dimension)))) {
                kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(i));
            } else {
                ++i;
            }
        }
    }
    return kept;
}

// Returns whether a variable is read only if the options name it: a variable without dimensions, a coordinate variable
// (named like its only dimension), or the bounds of a coordinate variable.
bool isCoordinateBoundsOrScalar(const NetcdfVariable& variable) {
    if (variable.dimensions.empty()) return true;
    const int dimension = variable.dimensions.front();
    if (variable.dimensions.size() == 1) return variable.name == dimensionName(variable.group, dimension);
    const auto coordinate = coordinateVariableOf(variable, dimension);
    return coordinate && (attributeText(*coordinate, "bounds") == variable.name ||
                          attributeText(*coordinate, "climatology") == variable.name);
}

// Returns the file's groups: the root group, then the groups within it, outer groups before inner groups. Stops at
// kMaxGroups groups.
std::vector<int> groupsOf(int file) {
    constexpr std::size_t kMaxGroups = 10'000;
    std::vector<int> groups{file};
    for (std::size_t i = 0; i < groups.size() && groups.size() < kMaxGroups; ++i) {
        int count = 0;
        if (nc_inq_grps(groups[i], &count, nullptr) != NC_NOERR || count <= 0) continue;
        std::vector<int> inner(static_cast<std::size_t>(count));
        if (nc_inq_grps(groups[i], &count, inner.data()) == NC_NOERR)
            groups.insert(groups.end(), inner.begin(), inner.end());
    }
    return groups;
}

// Returns the path of a variable, in the form that variableAtPath() accepts.
std::string pathOfVariable(const NetcdfVariable& variable, int file) {
    std::size_t length = 0;
    if (variable.group == file || nc_inq_grpname_full(variable.group, &length, nullptr) != NC_NOERR)
        return variable.name;
    std::string path(length, '\0');
    if (nc_inq_grpname_full(variable.group, &length, path.data()) != NC_NOERR) return variable.name;
    return path.substr(path.starts_with('/') ? 1 : 0) + '/' + variable.name;
}

Result<NetcdfVariable> defaultVariable(int file, FieldArray& field) {
    NetcdfVariable chosen;
    std::size_t candidates = 0, most = 0;
    for (const int group : groupsOf(file)) {
        int count = 0;
        if (nc_inq_nvars(group, &count) != NC_NOERR) return badFieldError("the file's variables cannot be read");
        for (int id = 0; id < count; ++id) {
            const auto variable = variableAt(group, id);
            if (!variable || typeRowOf(variable->type) == nullptr || isCoordinateBoundsOrScalar(*variable)) continue;
            const std::size_t dimensions = dimensionsAfterSqueeze(*variable).size();
            if (dimensions > 4) continue;
            ++candidates;
            if (dimensions <= most) continue;
            most = dimensions;
            chosen = *variable;
        }
    }
    if (candidates == 0) return badFieldError("the file has no variable of real numbers with 1 to 4 dimensions");
    if (candidates > 1) {
        field.warnings.push_back("of " + std::to_string(candidates) + " variables, " +
                                 text::inQuotes(pathOfVariable(chosen, file)) + " is shown");
    }
    return chosen;
}

Result<NetcdfVariable> variableAtPath(int file, const std::string& path) {
    const std::size_t slash = path.rfind('/');
    int group = file;
    const std::string name = slash == std::string::npos ? path : path.substr(slash + 1);
    if (slash != std::string::npos && slash > 0) {
        const std::string full = (path.starts_with('/') ? "" : "/") + path.substr(0, slash);
        if (nc_inq_grp_full_ncid(file, full.c_str(), &group) != NC_NOERR) group = -1;
    }
    auto variable = group < 0 ? std::nullopt : variableNamed(group, name);
    if (!variable) return Error{ErrorCode::not_found, "the file has no variable " + text::inQuotes(path)};
    if (typeRowOf(variable->type) == nullptr)
        return badFieldError("the variable " + text::inQuotes(path) + " does not consist of numbers");
    return *variable;
}

std::optional<FirstAndLastCoordinate> coordinateEndsOf(const NetcdfVariable& coordinate, std::size_t size,
                                                       const std::string& name, FieldArray& field) {
    const NetcdfTypeRow* const row = typeRowOf(coordinate.type);
    if (row == nullptr) return {};
    const std::size_t start = 0;
    std::vector<double> at(size);
    if (nc_get_vara_double(coordinate.group, coordinate.id, &start, &size, at.data()) != NC_NOERR) return {};
    const StoredNumberFormat format = netcdfNumberFormatOf(coordinate, *row);
    for (double& each : at) each = each * format.scale + format.offset;  // unpacks: CF conventions, section 8.1
    return endsOfCoordinates(at, name, field.warnings);
}

// Returns the dimensions in `kept` (see dimensionsAfterSqueeze()) with their axes. Sets the box and the units of
// `field`, and adds warnings to `field`.
Result<std::vector<ArrayDimension>> mapDimensions(const NetcdfVariable& variable, const std::vector<std::size_t>& kept,
                                                  const FieldReadOptions& options, FieldArray& field) {
    std::vector<CfDimension> stated;
    std::vector<std::optional<NetcdfVariable>> coordinates;
    std::vector<ArrayDimension> dimensions;
    for (const std::size_t index : kept) {
        const int id = variable.dimensions[index];
        stated.push_back(describeDimension(variable, id));
        coordinates.push_back(coordinateVariableOf(variable, id));
        std::size_t size = 0;
        if (nc_inq_dimlen(variable.group, id, &size) != NC_NOERR) return badFieldError("a dimension cannot be read");
        if (size > kMaxSamplesPerAxis) return Error{ErrorCode::too_large, "a dimension has more than 2^24 samples"};
        dimensions.push_back({size});
    }
    auto axes = parseAxes(options.axes, dimensions.size());  // parseAxes() also checks the number of dimensions
    if (!axes) return axes.error();
    if (options.axes.empty()) *axes = axisOfEachDimension(stated);
    field.box = {glm::dvec4(0), glm::dvec4(0)};
    for (std::size_t i = 0; i < dimensions.size(); ++i) {
        ArrayDimension& each = dimensions[i];
        each.axis = (*axes)[i];
        if (each.size == 0) return badFieldError("the array is empty");
        auto ends = coordinates[i] ? coordinateEndsOf(*coordinates[i], each.size, stated[i].name, field) : std::nullopt;
        if (ends && !options.box)
            subtractLeastCoordinateIfFar(*ends, each.size, stated[i].name, stated[i].units, field.warnings);
        field.boxIsKnown = field.boxIsKnown || ends;
        if (ends) field.units.at(each.axis) = stated[i].units;
        const FirstAndLastCoordinate found =
            ends.value_or(FirstAndLastCoordinate{0, static_cast<double>(each.size - 1)});
        each.reversed = found.last < found.first;
        const auto axis = static_cast<glm::length_t>(each.axis);
        field.box.min[axis] = std::min(found.first, found.last);
        field.box.max[axis] = std::max(found.first, found.last);
    }
    return dimensions;
}

Result<SampleStorage> readSlabs(const FileContents& file, const FieldReadOptions& options,
                                const NetcdfVariable& variable, const std::vector<std::size_t>& kept,
                                const AxisMapping& mapping) {
    const StoredNumberFormat format = netcdfNumberFormatOf(variable, *typeRowOf(variable.type));
    const std::size_t skipped = 4 - kept.size();
    std::vector<std::size_t> start(variable.dimensions.size(), 0), count(variable.dimensions.size(), 1);
    auto buffer = SampleBuffer::allocate(mapping.count(), options);
    if (!buffer) return buffer.error();
    // The cache keeps decompressed chunks, because the next slab often needs the same chunks. The result of the call is
    // ignored: the call fails for files without chunks, which need no cache.
    constexpr std::size_t kSlots = 4133;
    static_cast<void>(nc_set_var_chunk_cache(variable.group, variable.id, kChunkCacheSize, kSlots, 1));
    std::vector<std::byte> numbers;
    for (const Slab& slab : mapping.slabs(kSlabSize)) {
        const auto& size = slab.layout.size;
        numbers.resize(size[0] * size[1] * size[2] * size[3] * sizeOf(format.type));
        for (std::size_t i = 0; i < kept.size(); ++i) {
            start[kept[i]] = slab.start[skipped + i];
            count[kept[i]] = size[skipped + i];
        }
        const int status = nc_get_vara(variable.group, variable.id, start.data(), count.data(), numbers.data());
        if (status != NC_NOERR)
            return badFieldError("the variable cannot be read: " +
                                 text::printable(nc_strerror(status), kMaxNetcdfText));
        convertToFloats(format, numbers.data(), slab.layout, buffer->values().data() + slab.first);
        file.releasePages();
        buffer->releasePages();
    }
    return buffer->takeSamples();
}

}  // namespace

bool isNetcdfStart(std::span<const std::byte> start) {
    const std::string_view text(reinterpret_cast<const char*>(start.data()), start.size());
    return text.size() >= 4 && text.starts_with("CDF") && (text[3] == 1 || text[3] == 2 || text[3] == 5);
}

Result<FieldArray> readNetcdf(const FileContents& file, const FieldReadOptions& options) {
    const OpenNetcdfFile open(file);
    if (open.status() != NC_NOERR)
        return badFieldError("the file is not a valid NetCDF file: " +
                             text::printable(nc_strerror(open.status()), kMaxNetcdfText));
    FieldArray field;
    const auto variable =
        options.variable.empty() ? defaultVariable(open.id(), field) : variableAtPath(open.id(), options.variable);
    if (!variable) return variable.error();
    const std::vector<std::size_t> kept = dimensionsAfterSqueeze(*variable);
    const auto dimensions = mapDimensions(*variable, kept, options, field);
    if (!dimensions) return dimensions.error();
    const auto mapping = AxisMapping::fromDimensions(*dimensions, options.maxSamples);
    if (!mapping) return mapping.error();
    field.shape = mapping->shape();
    if (!field.boxIsKnown) field.box = defaultBox(field.shape, true);
    if (options.box) field.box = *options.box;
    field.boxIsKnown = field.boxIsKnown || options.box;
    auto samples = readSlabs(file, options, *variable, kept, *mapping);
    if (!samples) return samples.error();
    field.samples = *samples;
    std::string& quantity = field.quantity.name;
    quantity = attributeText(*variable, "long_name");
    if (quantity.empty()) quantity = attributeText(*variable, "standard_name");
    if (quantity.empty()) quantity = sanitizeQuantityText(variable->name);
    field.quantity.unit = attributeText(*variable, "units");
    return field;
}

}  // namespace oval4d::fields
