#include "fields/readers/zarr.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "fields/readers/axis_mapping.hpp"
#include "fields/readers/cf_conventions.hpp"
#include "fields/readers/sample_buffer.hpp"
#include "fields/readers/zarr_metadata.hpp"
#include "text/message_text.hpp"

namespace oval4d::fields {

namespace {

constexpr std::size_t kMaxMetadata = std::size_t{64} << 20U;  // maximum size of a metadata file, in bytes

FolderTextReader textsOf(const FolderFileReader& folder) {
    return [&folder](const std::string& path) -> Result<std::optional<std::string>> {
        auto file = folder(path);
        if (!file) return file.error();
        if (!*file) return std::optional<std::string>();
        const std::span<const std::byte> bytes = (*file)->bytes;
        if (bytes.size() > kMaxMetadata) return Error{ErrorCode::too_large, path + " is too large for Zarr metadata"};
        return std::optional(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    };
}

// Reads the chunks of an array.
class ChunkReader {
  public:
    ChunkReader(const FolderFileReader& folder, const ZarrArrayMetadata& array) : folder_(folder), array_(array) {}

    // Converts all chunks. `stride` has, for each dimension, the distance in `to` between neighbors along this
    // dimension; `first` is the place of the array's first number in `to`. `to` must contain only zeros before the
    // call, because missing chunks whose fill value is 0 are skipped. Calls `afterward` about once per kNumbers
    // numbers, so that the caller can release memory.
    template <typename Afterward>
    Result<std::monostate> read(const std::vector<std::ptrdiff_t>& stride, std::size_t first, float* to,
                                const Afterward& afterward) {
        constexpr std::size_t kNumbers = std::size_t{1} << 24U;  // numbers between two calls
        const std::size_t rank = array_.shape.size();
        std::vector<std::size_t> index(rank, 0);
        std::size_t numbers = 0;
        for (;;) {
            std::ptrdiff_t at = static_cast<std::ptrdiff_t>(first);
            for (std::size_t i = 0; i < rank; ++i)
                at += static_cast<std::ptrdiff_t>(index[i] * array_.chunk[i]) * stride[i];
            if (auto chunk = readChunk(index, stride, to + at); !chunk) return chunk;
            numbers += array_.decompressedChunkBytes() / sizeOf(array_.format.type);
            if (numbers >= kNumbers) {
                afterward();
                numbers = 0;
            }
            std::size_t i = rank;
            while (i > 0 && ++index[i - 1] * array_.chunk[i - 1] >= array_.shape[i - 1]) index[--i] = 0;
            if (i == 0) return std::monostate{};
        }
    }

  private:
    Result<std::monostate> readChunk(const std::vector<std::size_t>& index, const std::vector<std::ptrdiff_t>& stride,
                                     float* to) {
        const std::string path = array_.chunkPath(index);
        auto file = folder_(path);
        if (!file) return file.error();
        if (!*file) {
            fill(index, stride, to);
            return std::monostate{};
        }
        std::span<const std::byte> bytes = (*file)->bytes;
        if (array_.codec) {
            chunk_.resize(array_.decompressedChunkBytes());
            if (const auto done = decompress(*array_.codec, bytes, chunk_); !done)
                return badField("the chunk " + text::inQuotes(path) + " cannot be read: " + done.error().message);
            bytes = chunk_;
        } else if (bytes.size() != array_.decompressedChunkBytes()) {
            return badField("the chunk " + text::inQuotes(path) + " has " + std::to_string(bytes.size()) +
                            " bytes; it must have " + std::to_string(array_.decompressedChunkBytes()));
        }
        copy(index, stride, bytes.data(), to);
        if ((*file)->file && (*file)->file->isLost())
            return badField("the chunk " + text::inQuotes(path) + " was shortened");
        return std::monostate{};
    }

    // Returns how many indices along a dimension are both in the chunk `index` and in the array, because the last chunk
    // may extend beyond the array.
    std::size_t sizeWithin(const std::vector<std::size_t>& index, std::size_t dimension) const {
        return std::min(array_.chunk[dimension], array_.shape[dimension] - index[dimension] * array_.chunk[dimension]);
    }

    // Converts the numbers of the chunk `index` that are in the array, row by row. `from` is the decompressed chunk.
    void copy(const std::vector<std::size_t>& index, const std::vector<std::ptrdiff_t>& stride, const std::byte* from,
              float* to) const {
        const std::size_t size = sizeOf(array_.format.type);
        visitRows(index, stride, [&](std::size_t number, std::ptrdiff_t at, std::size_t count, std::ptrdiff_t step) {
            convert(array_.format, from + number * size, {{1, 1, 1, count}, {0, 0, 0, step}}, to + at);
        });
    }

    void fill(const std::vector<std::size_t>& index, const std::vector<std::ptrdiff_t>& stride, float* to) const {
        // The fill value is converted like all other stored numbers.
        NumberFormat format = array_.format;
        format.type = NumberType::f8;
        format.bigEndian = std::endian::native == std::endian::big;
        float value = 0;
        convert(format, reinterpret_cast<const std::byte*>(&array_.fill), {{1, 1, 1, 1}, {0, 0, 0, 0}}, &value);
        if (std::bit_cast<std::uint32_t>(value) == 0) return;  // `to` contains only zeros before read() is called
        visitRows(index, stride, [&](std::size_t, std::ptrdiff_t at, std::size_t count, std::ptrdiff_t step) {
            for (std::size_t i = 0; i < count; ++i) to[at + static_cast<std::ptrdiff_t>(i) * step] = value;
        });
    }

    // Visits the stored rows of a chunk that begin within the array. Calls `visit` for each row with four numbers: the
    // index of the row's first number in the chunk; the place of this number in `to`, relative to the place of the
    // chunk's first number; how many numbers of the row are within the array; and the distance between their places in
    // `to`.
    template <typename Visit>
    void visitRows(const std::vector<std::size_t>& index, const std::vector<std::ptrdiff_t>& stride,
                   const Visit& visit) const {
        const std::vector<std::size_t>& order = array_.order;
        const std::size_t rank = order.size(), fastest = order.back();
        std::vector<std::size_t> i(rank, 0);  // indices in the chunk, in the order of storage
        for (;;) {
            std::size_t number = 0;
            std::ptrdiff_t at = 0;
            for (std::size_t d = 0; d < rank; ++d) {
                number = number * array_.chunk[order[d]] + i[d];
                at += static_cast<std::ptrdiff_t>(i[d]) * stride[order[d]];
            }
            visit(number, at, sizeWithin(index, fastest), stride[fastest]);
            std::size_t d = rank - 1;
            while (d > 0 && ++i[d - 1] == sizeWithin(index, order[d - 1])) i[--d] = 0;
            if (d == 0) return;
        }
    }

    const FolderFileReader& folder_;
    const ZarrArrayMetadata& array_;
    std::vector<std::byte> chunk_;
};

// Reads the coordinates of a dimension from the array at `path`, which lies beside the array of the samples and has the
// dimension's name. Sets `units` and `stated` from the attributes of the array at `path`. Returns an empty optional if
// there is no such array, if it cannot be read, or if the dimension is empty.
std::optional<std::vector<double>> coordinates(const FolderFileReader& folder, const ZarrFolder& zarr,
                                               const std::string& path, std::size_t size, std::string& units,
                                               CfDimension& stated) {
    const auto found = zarr.array(path);
    if (!found || !*found) return {};
    ZarrArrayMetadata array = **found;
    if (array.shape != std::vector{size} || size == 0 || size > kMaxSamplesPerAxis) return {};
    units = quantityText(array.text("units"));
    stated = {stated.name, array.text("axis"), array.text("standard_name"), array.text("units"),
              array.text("positive")};
    array.format.missing.clear();  // coordinates are never missing, whatever the fill value is
    // Times are often large numbers with small differences, which 32-bit floats could not represent. Therefore the
    // coordinates are converted as differences from the first coordinate.
    std::vector<float> values(size);
    const double offset = array.format.offset;
    const auto read = [&] { return ChunkReader(folder, array).read({1}, 0, values.data(), [] {}).operator bool(); };
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

// Sets `kept` to the dimensions of the array, in ascending order. If there are more than four, leaves out dimensions of
// size 1 until four remain.
void squeeze(ZarrArrayMetadata& array, std::vector<std::size_t>& kept) {
    kept.resize(array.shape.size());
    std::iota(kept.begin(), kept.end(), std::size_t{0});
    for (std::size_t i = 0; i < kept.size() && kept.size() > 4;) {
        if (array.shape[kept[i]] == 1) {
            kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(i));
        } else {
            ++i;
        }
    }
}

// Returns the dimensions with their axes. Sets the box and the units of `field`, and adds warnings to it.
Result<std::vector<Dimension>> mapDimensions(const FolderFileReader& folder, const ZarrFolder& zarr,
                                             const ZarrArrayMetadata& array, const std::vector<std::size_t>& kept,
                                             const ReadOptions& options, FieldArray& field) {
    auto axes = parseAxes(options.axes, kept.size());  // also checks the number of dimensions
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
            unit = quantityText(statedUnit);
            range = {origin, origin + spacing * last, true};
        } else if (!array.dimensionNames.empty()) {
            each.name = array.dimensionNames[i];
        }
        named = named || !each.name.empty();
        if (!imageStatesCoordinates && !each.name.empty() && !array.path.empty()) {
            if (const auto at = coordinates(folder, zarr, group + each.name, size, unit, each)) {
                const auto ends = endsOfCoordinates(*at, each.name, field.warnings);
                if (ends) range = {ends->first, ends->last, true};
            }
        }
        stated.push_back(std::move(each));
        ranges.push_back(range);
        units.push_back(std::move(unit));
    }
    if (options.axes.empty() && named) *axes = axisOfEachDimension(stated);
    std::vector<Dimension> dimensions;
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

}  // namespace

Result<FieldArray> readZarr(const FolderFileReader& folder, const ReadOptions& options) {
    const ZarrFolder zarr(textsOf(folder));
    FieldArray field;
    std::string path = options.variable;
    while (path.starts_with('/')) path.erase(0, 1);
    auto found = zarr.array(path);
    if (found && !*found && path.empty()) {
        const auto chosen = zarr.chooseArray();
        if (!chosen) return chosen.error();
        path = chosen->path;
        if (chosen->all.size() > 1) {
            field.warnings.push_back("of " + std::to_string(chosen->all.size()) + " arrays, " + text::inQuotes(path) +
                                     " is shown");
        }
        found = zarr.array(path);
    }
    if (!found) return found.error();
    if (!*found) {
        std::vector<std::string_view> names;
        const auto chosen = zarr.chooseArray();
        if (chosen) names.assign(chosen->all.begin(), chosen->all.end());
        return Error{ErrorCode::not_found,
                     "the Zarr folder has no array " + text::inQuotes(path) + text::didYouMean(path, names)};
    }
    ZarrArrayMetadata& array = **found;
    std::vector<std::size_t> kept;
    squeeze(array, kept);
    const auto dimensions = mapDimensions(folder, zarr, array, kept, options, field);
    if (!dimensions) return dimensions.error();
    const auto mapping = AxisMapping::of(*dimensions, options.maxSamples);
    if (!mapping) return mapping.error();
    field.shape = mapping->shape();
    const bool time = options.axes.empty() || options.axes.find('t') != std::string::npos;
    if (!field.boxIsKnown) field.box = defaultBox(field.shape, time);
    if (options.box) field.box = *options.box;
    field.boxIsKnown = field.boxIsKnown || options.box;
    auto buffer = SampleBuffer::of(mapping->count(), options);
    if (!buffer) return buffer.error();
    std::vector<std::ptrdiff_t> stride(array.shape.size(), 0);  // 0 for the dimensions that are left out
    for (std::size_t i = 0; i < kept.size(); ++i) stride[kept[i]] = mapping->layout().stride.at(4 - kept.size() + i);
    const auto read =
        ChunkReader(folder, array).read(stride, mapping->firstSampleIndex(), buffer->values().data(), [&] {
            buffer->releasePages();
        });
    if (!read) return read.error();
    field.samples = buffer->take();
    field.quantity = {quantityText(array.text("long_name")), quantityText(array.text("units"))};
    // The path of a level of a multiscale image is a number, which says nothing about the quantity.
    if (field.quantity.name.empty() && !zarr.coordinatesOf(path))
        field.quantity.name = quantityText(path.substr(path.rfind('/') + 1));
    return field;
}

}  // namespace oval4d::fields
