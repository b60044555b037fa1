#include "fields/readers/zarr_metadata.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <set>
#include <utility>

#include "fields/array/shape.hpp"
#include "fields/readers/zarr_json.hpp"
#include "text/message_text.hpp"

namespace oval4d::fields {

using nlohmann::json;

namespace {

constexpr std::size_t kMaxZarrDimensions = 32;
constexpr std::size_t kMaxChunkBytes = std::size_t{512} << 20U;  // the maximum size of a decompressed chunk, in bytes
constexpr std::size_t kMaxArrays = 10'000;                       // the maximum number of arrays to choose from
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

Error unsupportedArrayError(const std::string& what) {
    return {ErrorCode::unsupported_format, "the Zarr array has " + what + ", which the server does not read"};
}

// Returns the member `name` of `object`, which must be a list of sizes: integers, each of them at least `least`.
Result<std::vector<std::size_t>> sizesIn(const json& object, std::string_view name, std::size_t least) {
    const json* const list = findMember(object, name);
    const auto what = std::string(name);
    if (list == nullptr || !list->is_array() || list->size() > kMaxZarrDimensions)
        return badMetadataError(what + " must be a list of at most " + std::to_string(kMaxZarrDimensions) +
                                " integers");
    std::vector<std::size_t> sizes;
    for (const json& each : *list) {
        if (!each.is_number_unsigned() || each.get<std::uint64_t>() < least ||
            each.get<std::uint64_t>() > kMaxSamples) {
            return badMetadataError(what + " has the size " + quoted(each) + "; it must be an integer from " +
                                    std::to_string(least) + " to 2^44");
        }
        sizes.push_back(each.get<std::size_t>());
    }
    return sizes;
}

// Returns the fill value, which is the value of all numbers of a missing chunk. Returns NaN if the metadata state none.
// In version 3, a hexadecimal number may state the bits of a float.
Result<double> fillValueIn(const json& metadata, const StoredNumberFormat& format) {
    const json* const value = findMember(metadata, "fill_value");
    if (value == nullptr) return kNone;
    if (const auto number = numberIn(*value)) return *number;
    const std::string text = value->is_string() ? value->get<std::string>() : std::string();
    const std::size_t size = sizeOf(format.type);
    std::uint64_t bits = 0;
    const auto [end, fault] =
        std::from_chars(text.data() + std::min<std::size_t>(text.size(), 2), text.data() + text.size(), bits, 16);
    if (text.starts_with("0x") && fault == std::errc() && end == text.data() + text.size()) {
        if (format.type == NumberType::f8) return std::bit_cast<double>(bits);
        if (format.type == NumberType::f4) return double{std::bit_cast<float>(static_cast<std::uint32_t>(bits))};
        if (size == 2 && bits >= 0x7c00U && (bits & 0x7fffU) > 0x7c00U) return kNone;
    }
    return badMetadataError("fill_value is " + quoted(*value));
}

std::optional<NumberType> zarrTypeNamed(std::string_view name) {
    static constexpr auto kZarrTypes = std::to_array<std::pair<std::string_view, NumberType>>({
        {"bool", NumberType::boolean},
        {"int8", NumberType::i1},
        {"uint8", NumberType::u1},
        {"int16", NumberType::i2},
        {"uint16", NumberType::u2},
        {"int32", NumberType::i4},
        {"uint32", NumberType::u4},
        {"int64", NumberType::i8},
        {"uint64", NumberType::u8},
        {"float16", NumberType::f2},
        {"float32", NumberType::f4},
        {"float64", NumberType::f8},
    });
    const auto* const found = std::ranges::find(kZarrTypes, name, &std::pair<std::string_view, NumberType>::first);
    if (found == kZarrTypes.end()) return {};
    return found->second;
}

Result<ZarrArrayMetadata> parseVersion2(const json& metadata) {
    ZarrArrayMetadata array;
    if (const json* const filters = findMember(metadata, "filters"); filters != nullptr && !filters->empty())
        return unsupportedArrayError("filters");
    const std::string type = stringMember(metadata, "dtype");
    const auto format = numberFormatOf(type);
    if (!format) {
        const json* const stated = findMember(metadata, "dtype");
        return unsupportedArrayError("the type " + (stated == nullptr ? "null" : quoted(*stated)));
    }
    array.format = *format;
    auto shape = sizesIn(metadata, "shape", 0), chunk = sizesIn(metadata, "chunks", 1);
    if (!shape) return shape.error();
    if (!chunk) return chunk.error();
    array.shape = std::move(*shape);
    array.chunk = std::move(*chunk);
    array.order.resize(array.shape.size());
    std::iota(array.order.begin(), array.order.end(), std::size_t{0});
    const std::string order = stringMember(metadata, "order");
    if (order == "F") {
        std::ranges::reverse(array.order);
    } else if (order != "C") {
        return badMetadataError("order must be C or F");
    }
    if (const json* const compressor = findMember(metadata, "compressor")) {
        array.codec = chunkCodecNamed(stringMember(*compressor, "id"));
        if (!array.codec)
            return unsupportedArrayError("the compressor " + text::inQuotes(stringMember(*compressor, "id")));
    }
    array.separator = stringMember(metadata, "dimension_separator");
    if (array.separator.empty()) array.separator = ".";
    return array;
}

Result<std::monostate> parseCodecs(const json& metadata, ZarrArrayMetadata& array) {
    const json* const codecs = findMember(metadata, "codecs");
    if (codecs == nullptr || !codecs->is_array()) return badMetadataError("codecs must be a list");
    bool hasBytes = false;
    for (const json& codec : *codecs) {
        const std::string name = codec.is_string() ? codec.get<std::string>() : stringMember(codec, "name");
        const json* const given = findMember(codec, "configuration");
        const json configuration = given == nullptr ? json::object() : *given;
        if (name == "sharding_indexed" && codecs->size() == 1 && !array.shards) {
            auto chunk = sizesIn(configuration, "chunk_shape", 1);
            if (!chunk) return chunk.error();
            auto shards = shardLayoutIn(configuration, array.chunk, *chunk);
            if (!shards) return shards.error();
            array.shards = std::move(*shards);
            array.chunk = std::move(*chunk);
            return parseCodecs(configuration, array);  // the codecs of the chunks
        }
        if (name == "transpose" && !hasBytes) {
            // The new transposition applies after the earlier transpositions, which array.order contains.
            auto order = sizesIn(configuration, "order", 0);
            if (!order) return order.error();
            std::vector<std::size_t> sorted = *order, transposed;
            std::ranges::sort(sorted);
            for (std::size_t i = 0; i < sorted.size(); ++i)
                if (sorted[i] != i) return badMetadataError("the order of transpose is not a permutation");
            if (sorted.size() != array.order.size())
                return badMetadataError("the order of transpose is not a permutation");
            for (const std::size_t i : *order) transposed.push_back(array.order[i]);
            array.order = std::move(transposed);
        } else if (name == "bytes" && !hasBytes) {
            hasBytes = true;
            const std::string endian = stringMember(configuration, "endian");
            if (endian != "little" && endian != "big" && sizeOf(array.format.type) > 1)
                return badMetadataError("endian must be little or big");
            array.format.bigEndian = endian == "big";
        } else if (const auto known = chunkCodecNamed(name); known && hasBytes && !array.codec) {
            array.codec = known;
        } else {
            return unsupportedArrayError("the codec " + text::inQuotes(name) + (known ? " twice" : ""));
        }
    }
    if (!hasBytes) return badMetadataError("the codec bytes is missing");
    return std::monostate{};
}

Result<ZarrArrayMetadata> parseVersion3(const json& metadata) {
    ZarrArrayMetadata array;
    const json* const stated = findMember(metadata, "data_type");
    const auto type = zarrTypeNamed(stringMember(metadata, "data_type"));
    if (!type) return unsupportedArrayError("the type " + (stated == nullptr ? "null" : quoted(*stated)));
    array.format.type = *type;
    auto shape = sizesIn(metadata, "shape", 0);
    if (!shape) return shape.error();
    array.shape = std::move(*shape);
    const json* const grid = findMember(metadata, "chunk_grid");
    if (grid == nullptr || stringMember(*grid, "name") != "regular" || findMember(*grid, "configuration") == nullptr)
        return unsupportedArrayError("a grid of chunks that is not regular");
    auto chunk = sizesIn(*findMember(*grid, "configuration"), "chunk_shape", 1);
    if (!chunk) return chunk.error();
    array.chunk = std::move(*chunk);
    array.order.resize(array.shape.size());
    std::iota(array.order.begin(), array.order.end(), std::size_t{0});
    if (auto parsed = parseCodecs(metadata, array); !parsed) return parsed.error();
    const json* const keys = findMember(metadata, "chunk_key_encoding");
    const std::string encoding = keys == nullptr ? "" : stringMember(*keys, "name");
    const json* const given = keys == nullptr ? nullptr : findMember(*keys, "configuration");
    array.separator = given == nullptr ? "" : stringMember(*given, "separator");
    if (encoding == "default") {
        if (array.separator.empty()) array.separator = "/";
        array.chunkPrefix = "c" + array.separator;
    } else if (encoding == "v2") {
        if (array.separator.empty()) array.separator = ".";
    } else {
        return unsupportedArrayError("the chunk keys " + text::inQuotes(encoding));
    }
    const json* const names = findMember(metadata, "dimension_names");
    if (names != nullptr && names->is_array() && names->size() == array.shape.size())
        for (const json& name : *names) array.dimensionNames.push_back(name.is_string() ? name.get<std::string>() : "");
    const json* const attributes = findMember(metadata, "attributes");
    array.attributes = attributes == nullptr ? json::object() : *attributes;
    return array;
}

// Applies the attributes of the CF conventions, version 1.10, sections 2.5 and 8.1.
void applyCfAttributes(ZarrArrayMetadata& array) {
    const auto numbers = [&](std::string_view attribute) {
        std::vector<double> found;
        const json* const value = findMember(array.attributes, attribute);
        if (value == nullptr) return found;
        for (const json& each : value->is_array() ? *value : json::array({*value}))
            if (const auto number = numberIn(each); number && !std::isnan(*number)) found.push_back(*number);
        return found;
    };
    const auto first = [&](std::string_view attribute, double otherwise) {
        const auto found = numbers(attribute);
        return found.size() == 1 ? found[0] : otherwise;
    };
    array.format.missing = numbers("_FillValue");
    const NumberType type = array.format.type;
    if (type == NumberType::f2 || type == NumberType::f4 || type == NumberType::f8) {
        const auto encoded = base64DoubleIn(stringMember(array.attributes, "_FillValue"));
        if (encoded && !std::isnan(*encoded)) array.format.missing.push_back(*encoded);
    }
    for (const double number : numbers("missing_value")) array.format.missing.push_back(number);
    array.format.min = first("valid_min", array.format.min);
    array.format.max = first("valid_max", array.format.max);
    if (const auto range = numbers("valid_range"); range.size() == 2) {
        array.format.min = range[0];
        array.format.max = range[1];
    }
    array.format.roundLimitsToType();
    array.format.scale = first("scale_factor", 1);
    array.format.offset = first("add_offset", 0);
}

Result<ZarrArrayMetadata> checkedMetadata(ZarrArrayMetadata array) {
    if (array.chunk.size() != array.shape.size())
        return badMetadataError("the shapes of the array and of its chunks differ in length");
    if (array.separator != "." && array.separator != "/") return badMetadataError("the separator must be . or /");
    std::size_t bytes = sizeOf(array.format.type);
    for (const std::size_t size : array.chunk) {
        if (size > kMaxChunkBytes / bytes) {
            return Error{ErrorCode::too_large, "a chunk of the Zarr array takes more than the allowed " +
                                                   std::to_string(kMaxChunkBytes >> 20U) + " MiB"};
        }
        bytes *= size;
    }
    return array;
}

// Applies a scale or a translation of a multiscale image to the coordinates of its samples.
void applyTransformation(const json& transformation, ZarrCoordinates& coordinates) {
    for (const std::string_view kind : {"scale", "translation"}) {
        const json* const numbers = findMember(transformation, kind);
        if (numbers == nullptr || !numbers->is_array() || numbers->size() != coordinates.dimensions.size()) continue;
        for (std::size_t i = 0; i < numbers->size(); ++i) {
            const double number = numberIn((*numbers)[i]).value_or(kNone);
            auto& [name, unit, origin, spacing] = coordinates.dimensions[i];
            if (kind == "translation" && std::isfinite(number)) origin += number;
            if (kind == "scale" && std::isfinite(number) && number > 0) {
                origin *= number;
                spacing *= number;
            }
        }
    }
}

// Returns whether a path stays inside its folder. Returns false if a name in the path is empty, "." or "..", or
// contains a null character.
bool staysInFolder(std::string_view path) {
    for (std::size_t begin = 0; begin <= path.size() && !path.empty();) {
        const std::size_t end = std::min(path.find('/', begin), path.size());
        const std::string_view name = path.substr(begin, end - begin);
        if (name.empty() || name == "." || name == ".." || name.find('\0') != std::string_view::npos) return false;
        begin = end + 1;
    }
    return true;
}

std::string joinPath(const std::string& folder, std::string_view name) {
    return folder.empty() ? std::string(name) : folder + '/' + std::string(name);
}

}  // namespace

std::string ZarrArrayMetadata::stringAttribute(std::string_view attribute) const {
    return stringMember(attributes, attribute);
}

std::string ZarrArrayMetadata::chunkPath(const std::vector<std::size_t>& indices) const {
    std::string name = chunkPrefix;
    for (std::size_t i = 0; i < indices.size(); ++i) name += (i == 0 ? "" : separator) + std::to_string(indices[i]);
    return joinPath(path, name);
}

std::size_t ZarrArrayMetadata::decompressedChunkBytes() const {
    return std::accumulate(chunk.begin(), chunk.end(), sizeOf(format.type), std::multiplies<>());
}

Result<std::optional<json>> ZarrFolder::json(const std::string& path) const {
    auto text = read_(path);
    if (!text) return text.error();
    if (!*text) return std::optional<nlohmann::json>();
    nlohmann::json value = nlohmann::json::parse(replaceNanByNull(std::move(**text)), nullptr, false);
    if (!value.is_object()) return badMetadataError(path + " is not a JSON object");
    return std::optional(std::move(value));
}

Result<std::optional<ZarrArrayMetadata>> ZarrFolder::array(const std::string& path) const {
    if (!staysInFolder(path)) {
        return Error{ErrorCode::out_of_range, "the path " + text::inQuotes(path) +
                                                  " must consist of names in the Zarr folder, without . and .."};
    }
    auto metadata = json(joinPath(path, "zarr.json"));
    if (!metadata) return metadata.error();
    const bool isVersion3 = metadata->has_value();
    if (!isVersion3) metadata = json(joinPath(path, ".zarray"));
    if (!metadata) return metadata.error();
    const auto format = isVersion3 ? 3 : 2;
    if (!*metadata || (isVersion3 && stringMember(**metadata, "node_type") != "array"))
        return std::optional<ZarrArrayMetadata>();
    const nlohmann::json* const stated = findMember(**metadata, "zarr_format");
    if (stated == nullptr || *stated != format)
        return badMetadataError("zarr_format must be " + std::to_string(format));
    auto array = isVersion3 ? parseVersion3(**metadata) : parseVersion2(**metadata);
    if (!array) return array.error();
    array->path = path;
    if (!isVersion3) {
        auto attributes = json(joinPath(path, ".zattrs"));
        if (!attributes) return attributes.error();
        array->attributes = *attributes ? **attributes : nlohmann::json::object();
        const nlohmann::json* const names = findMember(array->attributes, "_ARRAY_DIMENSIONS");
        if (names != nullptr && names->is_array() && names->size() == array->shape.size())
            for (const auto& name : *names)
                array->dimensionNames.push_back(name.is_string() ? name.get<std::string>() : "");
    }
    auto fill = fillValueIn(**metadata, array->format);
    if (!fill) return fill.error();
    array->fill = array->format.roundedToType(*fill);
    applyCfAttributes(*array);
    // An array with _ARRAY_DIMENSIONS was written by xarray. In version 2, xarray stores the attribute _FillValue as
    // fill_value, so samples with this value are missing.
    if (!isVersion3 && !array->dimensionNames.empty() && !std::isnan(*fill))
        array->format.missing.push_back(array->fill);
    auto valid = checkedMetadata(std::move(*array));
    if (!valid) return valid.error();
    return std::optional(std::move(*valid));
}

json ZarrFolder::groupAttributes() const {
    if (const auto group = json("zarr.json"); group && *group) {
        const nlohmann::json* const attributes = findMember(**group, "attributes");
        if (attributes == nullptr) return nlohmann::json::object();
        const nlohmann::json* const ome = findMember(*attributes, "ome");
        return ome != nullptr ? *ome : *attributes;
    }
    const auto attributes = json(".zattrs");
    return attributes && *attributes ? **attributes : nlohmann::json::object();
}

std::optional<ZarrCoordinates> ZarrFolder::coordinatesOf(const std::string& path) const {
    const nlohmann::json attributes = groupAttributes();
    const nlohmann::json* const images = findMember(attributes, "multiscales");
    if (images == nullptr || !images->is_array() || images->empty()) return {};
    const nlohmann::json& image = images->front();
    const nlohmann::json *const levels = findMember(image, "datasets"), *const axes = findMember(image, "axes");
    if (levels == nullptr || !levels->is_array() || axes == nullptr || !axes->is_array()) return {};
    const auto level =
        std::ranges::find_if(*levels, [&](const auto& each) { return stringMember(each, "path") == path; });
    if (level == levels->end()) return {};
    ZarrCoordinates coordinates;
    for (const auto& axis : *axes)
        coordinates.dimensions.push_back(
            {axis.is_string() ? axis.get<std::string>() : stringMember(axis, "name"), stringMember(axis, "unit")});
    // The transformations of the level apply before those of the image (OME-NGFF 0.4, section "multiscales").
    for (const nlohmann::json* const owner : {&*level, &image}) {
        const nlohmann::json* const transformations = findMember(*owner, "coordinateTransformations");
        if (transformations == nullptr || !transformations->is_array()) continue;
        for (const auto& each : *transformations) applyTransformation(each, coordinates);
    }
    return coordinates;
}

Result<ZarrFolder::DefaultArrayChoice> ZarrFolder::chooseArray() const {
    const nlohmann::json attributes = groupAttributes();
    DefaultArrayChoice chosen;
    if (const nlohmann::json* const images = findMember(attributes, "multiscales");
        images != nullptr && images->is_array() && !images->empty()) {
        const nlohmann::json* const levels = findMember(images->front(), "datasets");
        if (levels != nullptr && levels->is_array() && !levels->empty()) {
            for (const auto& level : *levels) chosen.all.push_back(stringMember(level, "path"));
            chosen.path = chosen.all.front();
            chosen.areLevels = true;
            return chosen;
        }
    }
    // The consolidated metadata contain the metadata of all arrays, but only the paths of the arrays are used here.
    std::set<std::string> paths;
    if (const auto group = json("zarr.json"); group && *group) {
        const nlohmann::json* const all = findMember(**group, "consolidated_metadata");
        const nlohmann::json* const members = all == nullptr ? nullptr : findMember(*all, "metadata");
        if (members != nullptr && members->is_object())
            for (const auto& [path, value] : members->items())
                if (stringMember(value, "node_type") == "array") paths.insert(path);
    } else if (const auto all = json(".zmetadata"); all && *all) {
        constexpr std::string_view kArray = "/.zarray";
        const nlohmann::json* const members = findMember(**all, "metadata");
        if (members != nullptr && members->is_object())
            for (const auto& [path, value] : members->items())
                if (path.ends_with(kArray)) paths.insert(path.substr(0, path.size() - kArray.size()));
    }
    const auto has = [&](const std::string& file) {
        const auto found = json(file);
        return !found || *found;
    };
    if (!has("zarr.json") && !has(".zmetadata") && !has(".zgroup") && !has(".zattrs")) {
        return Error{ErrorCode::unsupported_format,
                     "the folder contains no Zarr array or group: it has no file zarr.json, .zarray or .zgroup"};
    }
    if (paths.empty() || paths.size() > kMaxArrays) {
        return Error{ErrorCode::out_of_range,
                     "the folder is a Zarr group without consolidated metadata; name its array as variable"};
    }
    std::size_t dimensions = 0;
    for (const std::string& path : paths) {
        const auto found = array(path);
        if (!found || !*found) continue;
        const ZarrArrayMetadata& each = **found;
        chosen.all.push_back(path);
        const std::string name = path.substr(path.rfind('/') + 1);
        const bool isCoordinate = each.shape.size() == 1 && each.dimensionNames == std::vector{name};
        if (isCoordinate || each.shape.size() <= dimensions) continue;
        dimensions = each.shape.size();
        chosen.path = path;
    }
    if (dimensions == 0) return Error{ErrorCode::bad_field, "the Zarr group has no array that the server reads"};
    return chosen;
}

}  // namespace oval4d::fields
