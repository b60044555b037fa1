#include "fields/readers/zarr.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fields/readers/axis_mapping.hpp"
#include "fields/readers/cf_conventions.hpp"
#include "fields/readers/sample_buffer.hpp"
#include "fields/readers/zarr_chunk_reader.hpp"
#include "fields/readers/zarr_metadata.hpp"
#include "text/message_text.hpp"

namespace oval4d::fields {

namespace {

constexpr std::size_t kMaxMetadata = std::size_t{64} << 20U;  // the maximum size of a metadata file, in bytes

// Returns a function that reads metadata files. The function keeps their texts, because readZarr() needs the same file
// several times, and reading a file may be a request to a remote store.
FolderTextReader cachingTextReader(const FolderFileReader& folder) {
    using Texts = std::map<std::string, std::optional<std::string>>;
    return [&folder, known = Texts()](const std::string& path) mutable -> Result<std::optional<std::string>> {
        if (const auto found = known.find(path); found != known.end()) return found->second;
        auto file = folder(path, {});
        if (!file) return file.error();
        std::optional<std::string> text;
        if (*file) {
            const std::span<const std::byte> bytes = (*file)->bytes;
            if (bytes.size() > kMaxMetadata)
                return Error{ErrorCode::too_large, path + " is too large for Zarr metadata"};
            text.emplace(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        }
        known.emplace(path, text);
        return text;
    };
}

// Reads the coordinates of a dimension from the array at `path`, which is next to the array of samples and has the
// dimension's name. Sets `units` and `stated` from the attributes of the array at `path`. Returns an empty optional if
// there is no such array, if it cannot be read, or if the dimension is empty.
std::optional<std::vector<double>> readCoordinates(const FolderFileReader& folder, const ZarrFolder& zarr,
                                                   const std::string& path, std::size_t size, std::string& units,
                                                   CfDimension& stated) {
    const auto found = zarr.array(path);
    if (!found || !*found) return {};
    ZarrArrayMetadata array = **found;
    if (array.shape != std::vector{size} || size == 0 || size > kMaxSamplesPerAxis) return {};
    units = sanitizeQuantityText(array.stringAttribute("units"));
    stated = {stated.name, array.stringAttribute("axis"), array.stringAttribute("standard_name"),
              array.stringAttribute("units"), array.stringAttribute("positive")};
    array.format.missing.clear();  // coordinates are never missing, even if they equal the fill value
    // Times are often large numbers with small differences, which 32-bit floats could not represent. Therefore the
    // coordinates are read as differences from the first coordinate.
    std::vector<float> values(size);
    const double offset = array.format.offset;
    const auto read = [&] {
        return ZarrChunkReader(folder, array, {{0}, {size}}).read({1}, 0, values.data(), [] {}).operator bool();
    };
    if (!read()) return {};
    const double first = double{values.front()} - offset;
    if (!std::isfinite(first)) return {};
    array.format.offset = -first;
    std::ranges::fill(values, 0.F);
    if (!read()) return {};
    std::vector<double> at;
    for (const float value : values) at.push_back(first + offset + value);
    return at;
}

// Returns the dimensions in `kept` with their axes. Sets the box and the units of `field`, and adds warnings to
// `field`.
Result<std::vector<ArrayDimension>> mapDimensions(const FolderFileReader& folder, const ZarrFolder& zarr,
                                                  const ZarrArrayMetadata& array, const std::vector<std::size_t>& kept,
                                                  const FieldReadOptions& options, FieldArray& field) {
    auto axes = parseAxes(options.axes, kept.size());  // parseAxes() also checks the number of dimensions
    if (!axes) return axes.error();
    const auto ofImage = zarr.coordinatesOf(array.path);
    const bool imageStatesCoordinates = ofImage && ofImage->dimensions.size() == array.shape.size();
    const std::size_t slash = array.path.rfind('/');
    const std::string group = slash == std::string::npos ? "" : array.path.substr(0, slash + 1);
    struct CoordinateRange {
        double first, last;
        bool known;
    };
    std::vector<CfDimension> stated;
    std::vector<CoordinateRange> ranges;
    std::vector<std::string> units;
    bool named = false;
    for (const std::size_t i : kept) {
        const std::size_t size = array.shape[i];
        const double last = static_cast<double>(size) - 1;
        CfDimension each;
        CoordinateRange range{0, last, false};
        std::string unit;
        if (imageStatesCoordinates) {
            const auto& [name, statedUnit, origin, spacing] = ofImage->dimensions[i];
            each.name = name;
            unit = sanitizeQuantityText(statedUnit);
            range = {origin, origin + spacing * last, true};
        } else if (!array.dimensionNames.empty()) {
            each.name = array.dimensionNames[i];
        }
        named = named || !each.name.empty();
        if (!imageStatesCoordinates && !each.name.empty() && !array.path.empty()) {
            if (const auto at = readCoordinates(folder, zarr, group + each.name, size, unit, each)) {
                auto ends = endsOfCoordinates(*at, each.name, field.warnings);
                if (ends && !options.box) subtractLeastCoordinateIfFar(*ends, size, each.name, unit, field.warnings);
                if (ends) range = {ends->first, ends->last, true};
            }
        }
        stated.push_back(std::move(each));
        ranges.push_back(range);
        units.push_back(std::move(unit));
    }
    if (options.axes.empty() && named) *axes = axisOfEachDimension(stated);
    std::vector<ArrayDimension> dimensions;
    field.box = {glm::dvec4(0), glm::dvec4(0)};
    for (std::size_t i = 0; i < kept.size(); ++i) {
        const auto& [first, last, known] = ranges[i];
        dimensions.push_back({array.shape[kept[i]], (*axes)[i], last < first});
        const auto axis = static_cast<glm::length_t>((*axes)[i]);
        field.box.min[axis] = std::min(first, last);
        field.box.max[axis] = std::max(first, last);
        if (known) field.units.at((*axes)[i]) = units[i];
        field.boxIsKnown = field.boxIsKnown || known;
    }
    return dimensions;
}

// Returns the error `not_found` for an array that does not exist, with the path of the array.
Error missingArrayError(const ZarrFolder& zarr, const std::string& path) {
    std::vector<std::string_view> names;
    const auto chosen = zarr.chooseArray();
    if (chosen) names.assign(chosen->all.begin(), chosen->all.end());
    return {ErrorCode::not_found,
            "the Zarr folder has no array " + text::inQuotes(path) + text::didYouMean(path, names)};
}

// A range of samples of an axis: `count` samples, from the index `first` on.
struct AxisSampleRange {
    std::size_t first, count;
};

// Returns the samples of an axis that cover the interval from `from` to `to` as far as possible. If the interval has no
// length, returns the nearest sample. The coordinates of the first and the last sample are `min` and `max`. Returns all
// samples if `min` and `max` are not valid.
AxisSampleRange samplesCovering(double from, double to, double min, double max, std::size_t samples) {
    constexpr double kTolerance = 1e-6;  // in distances between samples; allows for the rounding of coordinates
    if (samples <= 1 || !(min < max) || !std::isfinite(max - min)) return {0, samples};
    const double last = static_cast<double>(samples) - 1;
    const auto position = [&](double at) { return std::clamp((at - min) / (max - min) * last, 0.0, last); };
    if (from == to) return {static_cast<std::size_t>(std::round(position(from))), 1};
    const double first = std::min(std::floor(position(from) + kTolerance), last - 1);
    const double end = std::max(std::ceil(position(to) - kTolerance), first + 1);
    return {static_cast<std::size_t>(first), static_cast<std::size_t>(end - first) + 1};
}

// The part of an array that is read.
struct ZarrArrayPart {
    ZarrArrayMetadata array;
    IndexBox indices;
    std::vector<std::size_t> kept;           // the dimensions that become axes (see squeezedDimensionIndices())
    std::vector<ArrayDimension> dimensions;  // the dimensions in `kept`, with the sizes of the part
    FieldArray field;                        // the array, without its shape and its samples
    std::uint32_t finer = 0;                 // see MultiscaleImageLevel::finer
};

// Restricts a part, which must be the whole array, to the samples that cover `region`. Error: `out_of_range` if the
// region lies beyond the box of the array, unless `mayLieBeyond` is true.
std::optional<Error> restrictPartToRegion(const Box& region, bool mayLieBeyond, ZarrArrayPart& part) {
    Box& box = part.field.box;
    for (std::size_t i = 0; i < part.kept.size(); ++i) {
        ArrayDimension& dimension = part.dimensions[i];
        const auto axis = static_cast<glm::length_t>(dimension.axis);
        const double min = box.min[axis], max = box.max[axis];
        const std::size_t samples = dimension.size;
        if (samples > 1 && !mayLieBeyond && (region.max[axis] < min || region.min[axis] > max)) {
            return Error{ErrorCode::out_of_range,
                         std::string("the region lies beyond the array, which extends along ") + "xyzw"[axis] +
                             " from " + text::roundedDecimal(min) + " to " + text::roundedDecimal(max)};
        }
        const auto [first, count] = samplesCovering(region.min[axis], region.max[axis], min, max, samples);
        if (count == samples) continue;
        const double step = (max - min) / (static_cast<double>(samples) - 1);
        box.min[axis] = min + step * static_cast<double>(first);
        if (first + count < samples) box.max[axis] = min + step * static_cast<double>(first + count - 1);
        if (count == 1) box.max[axis] = box.min[axis];
        part.indices.first[part.kept[i]] = dimension.reversed ? samples - first - count : first;
        part.indices.size[part.kept[i]] = dimension.size = count;
        part.field.isPart = true;
    }
    return {};
}

// Returns the part of an array that the options select. `isCoarser` says whether the array is a level of an image, but
// not the finest level. Its samples may then lie between those of the finest level, and not reach the ends of the box
// of the finest level.
Result<ZarrArrayPart> selectedPart(const FolderFileReader& folder, const ZarrFolder& zarr, ZarrArrayMetadata array,
                                   const FieldReadOptions& options, bool isCoarser = false) {
    ZarrArrayPart part{std::move(array), {}, {}, {}, {}};
    part.kept = squeezedDimensionIndices(part.array.shape);
    part.indices = {std::vector<std::size_t>(part.array.shape.size(), 0), part.array.shape};
    auto dimensions = mapDimensions(folder, zarr, part.array, part.kept, options, part.field);
    if (!dimensions) return dimensions.error();
    part.dimensions = std::move(*dimensions);
    FieldArray& field = part.field;
    Shape shape{1, 1, 1, 1};  // the shape of the whole array
    for (const ArrayDimension& each : part.dimensions) shape.at(each.axis) = each.size;
    const bool time = options.axes.empty() || options.axes.find('t') != std::string::npos;
    if (!field.boxIsKnown) field.box = defaultBox(shape, time);
    if (options.box) field.box = *options.box;
    field.boxIsKnown = field.boxIsKnown || options.box;
    if (options.region) {
        if (auto error = restrictPartToRegion(*options.region, isCoarser, part)) return std::move(*error);
    }
    return part;
}

// Returns the selected part of an array. The option `variable` names the array, and the option `region` selects the
// part. Without a name, chooses the array as readZarr() describes.
Result<ZarrArrayPart> chosenArrayPart(const FolderFileReader& folder, const ZarrFolder& zarr,
                                      const FieldReadOptions& options) {
    std::string path = options.variable;
    while (path.starts_with('/')) path.erase(0, 1);
    auto named = zarr.array(path);
    if (!named) return named.error();
    if (*named) return selectedPart(folder, zarr, std::move(**named), options);
    if (!path.empty()) return missingArrayError(zarr, path);
    const auto chosen = zarr.chooseArray();
    if (!chosen) return chosen.error();
    const std::vector<std::string> candidates = chosen->areLevels ? chosen->all : std::vector{chosen->path};
    if (options.level && (!chosen->areLevels || *options.level >= candidates.size()))
        return Error{ErrorCode::not_found, "the image has no level " + std::to_string(*options.level)};
    const std::size_t maxInMemory = std::min(options.maxSamples, options.maxInMemory);
    std::size_t finest = candidates.size();  // the index of the finest level that fits into memory
    for (std::size_t i = 0;; ++i) {
        auto array = zarr.array(candidates[i]);
        if (!array) return array.error();
        if (!*array) return missingArrayError(zarr, candidates[i]);
        auto part = selectedPart(folder, zarr, std::move(**array), options, i > 0);
        if (!part) return part.error();
        const auto fitsInto = [&](std::size_t maxSamples) -> std::optional<Error> {
            const auto mapping = AxisMapping::fromDimensions(part->dimensions, maxSamples);
            return mapping ? std::nullopt : std::optional(mapping.error());
        };
        const auto isTooLargeFor = [&](std::size_t maxSamples) {
            const auto fault = fitsInto(maxSamples);
            return fault && fault->code == ErrorCode::too_large;
        };
        const bool isTooLarge = isTooLargeFor(maxInMemory);
        if (!isTooLarge) finest = std::min(finest, i);
        const bool isLast = i + 1 == candidates.size();
        if (options.level ? i < *options.level
                          : !isLast && isTooLargeFor(std::min(maxInMemory, options.maxInFirstLevel)))
            continue;
        if (options.level && isTooLarge) return *fitsInto(maxInMemory);
        if (finest < i) part->finer = static_cast<std::uint32_t>(i - finest);
        std::string warning = "of " + std::to_string(chosen->all.size()) + (i > 0 ? " levels, " : " arrays, ") +
                              text::inQuotes(candidates[i]) + " is shown";
        if (part->finer > 0) {
            warning += " first; finer ones follow";
        } else if (i > 0) {
            warning += std::string(isTooLarge ? ", the coarsest one" : ", the finest one that fits into memory") +
                       "; a region of the array is shown in more detail";
        }
        if (i > 0) part->field.isPart = true;
        if (chosen->all.size() > 1) part->field.warnings.insert(part->field.warnings.begin(), std::move(warning));
        return part;
    }
}

// Returns which level of a multiscale image the array at `path` is; MultiscaleImageLevel::finer is not set. Returns
// a default MultiscaleImageLevel if the array is not a level of such an image.
MultiscaleImageLevel imageLevelOf(const ZarrFolder& zarr, const std::string& path) {
    const auto chosen = zarr.chooseArray();
    if (!chosen || !chosen->areLevels) return {};
    const auto found = std::ranges::find(chosen->all, path);
    if (found == chosen->all.end()) return {};
    return {static_cast<std::uint32_t>(found - chosen->all.begin()), static_cast<std::uint32_t>(chosen->all.size())};
}

}  // namespace

Result<FieldArray> readZarr(const FolderFileReader& folder, const FieldReadOptions& options) {
    const ZarrFolder zarr(cachingTextReader(folder));
    auto part = chosenArrayPart(folder, zarr, options);
    if (!part) return part.error();
    const ZarrArrayMetadata& array = part->array;
    const std::vector<std::size_t>& kept = part->kept;
    FieldArray& field = part->field;
    const auto mapping = AxisMapping::fromDimensions(part->dimensions, options.maxSamples);
    if (!mapping) return mapping.error();
    field.shape = mapping->shape();
    auto buffer = SampleBuffer::allocate(mapping->count(), options);
    if (!buffer) return buffer.error();
    std::vector<std::ptrdiff_t> stride(array.shape.size(), 0);  // 0 for dimensions that are not in `kept`
    for (std::size_t i = 0; i < kept.size(); ++i) stride[kept[i]] = mapping->layout().stride.at(4 - kept.size() + i);
    const auto read =
        ZarrChunkReader(folder, array, part->indices)
            .read(stride, mapping->firstSampleIndex(), buffer->values().data(), [&] { buffer->releasePages(); });
    if (!read) return read.error();
    field.samples = buffer->takeSamples();
    field.quantity = {sanitizeQuantityText(array.stringAttribute("long_name")),
                      sanitizeQuantityText(array.stringAttribute("units"))};
    // The path of a level of a multiscale image is a number, which is no name of a quantity.
    if (field.quantity.name.empty() && !zarr.coordinatesOf(array.path))
        field.quantity.name = sanitizeQuantityText(array.path.substr(array.path.rfind('/') + 1));
    field.imageLevel = imageLevelOf(zarr, array.path);
    field.imageLevel.finer = std::min(part->finer, field.imageLevel.level);
    return std::move(field);
}

}  // namespace oval4d::fields
