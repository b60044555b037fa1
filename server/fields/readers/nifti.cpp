#include "fields/readers/nifti.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fields/readers/axis_mapping.hpp"
#include "fields/readers/gzip.hpp"

namespace oval4d::fields {

namespace {

constexpr std::size_t kHeader1 = 348, kHeader2 = 540;  // sizes of the headers of NIfTI-1 and NIfTI-2 in bytes
constexpr double kMaxDataAt = 1 << 24;  // the maximum number of bytes of header and extensions before the data
constexpr std::size_t kDimensions = 7;

// Reads numbers of a NIfTI header by their offsets (see nifti1.h and nifti2.h of the NIfTI reference library).
class NiftiHeaderReader {
  public:
    NiftiHeaderReader(std::span<const std::byte> bytes, bool bigEndian) : bytes_(bytes), bigEndian_(bigEndian) {}

    template <typename Number>
    Number readAt(std::size_t offset) const {
        std::array<std::byte, sizeof(Number)> number;
        std::memcpy(number.data(), &bytes_[offset], sizeof(Number));
        if (bigEndian_ != (std::endian::native == std::endian::big)) std::reverse(number.begin(), number.end());
        return std::bit_cast<Number>(number);
    }
    std::string textAt(std::size_t offset, std::size_t length) const {
        const std::string_view text(reinterpret_cast<const char*>(&bytes_[offset]), length);
        return sanitizeQuantityText(text.substr(0, text.find('\0')));
    }

  private:
    std::span<const std::byte> bytes_;
    bool bigEndian_;
};

// The members of a NIfTI-1 or NIfTI-2 header that the reader uses.
struct NiftiHeader {
    bool bigEndian = false;
    std::int64_t dimensions = 0;
    std::array<std::int64_t, kDimensions> size{};
    std::array<double, 5> spacing{};  // `pixdim` of the header: the sign of the third axis, then the distances between
                                      // samples along four dimensions
    int type = 0, units = 0, qform = 0, sform = 0;
    double dataAt = 0, slope = 0, intercept = 0, firstTime = 0;
    std::array<double, 3> quaternion{}, offset{};
    std::array<std::array<double, 4>, 3> rows{};
    std::string quantity;
};

// Returns whether the byte order is big-endian. The first number of a file must be the length of the header in one of
// the two byte orders; otherwise, returns an empty optional.
std::optional<bool> isBigEndian(std::span<const std::byte> start, std::size_t headerLength) {
    if (start.size() < 4) return {};
    for (const bool bigEndian : {false, true}) {
        if (NiftiHeaderReader(start, bigEndian).readAt<std::uint32_t>(0) == headerLength) return bigEndian;
    }
    return {};
}

NiftiHeader parseNifti1(const NiftiHeaderReader& bytes) {
    NiftiHeader header;
    header.dimensions = bytes.readAt<std::int16_t>(40);
    for (std::size_t i = 0; i < kDimensions; ++i) header.size[i] = bytes.readAt<std::int16_t>(42 + 2 * i);
    header.type = bytes.readAt<std::int16_t>(70);
    for (std::size_t i = 0; i < 5; ++i) header.spacing[i] = bytes.readAt<float>(76 + 4 * i);
    header.dataAt = bytes.readAt<float>(108);
    header.slope = bytes.readAt<float>(112);
    header.intercept = bytes.readAt<float>(116);
    header.units = bytes.readAt<std::uint8_t>(123);
    header.firstTime = bytes.readAt<float>(136);
    header.qform = bytes.readAt<std::int16_t>(252);
    header.sform = bytes.readAt<std::int16_t>(254);
    for (std::size_t i = 0; i < 3; ++i) {
        header.quaternion[i] = bytes.readAt<float>(256 + 4 * i);
        header.offset[i] = bytes.readAt<float>(268 + 4 * i);
        for (std::size_t j = 0; j < 4; ++j) header.rows[i][j] = bytes.readAt<float>(280 + 16 * i + 4 * j);
    }
    header.quantity = bytes.textAt(328, 16);
    return header;
}

NiftiHeader parseNifti2(const NiftiHeaderReader& bytes) {
    NiftiHeader header;
    header.type = bytes.readAt<std::int16_t>(12);
    header.dimensions = bytes.readAt<std::int64_t>(16);
    for (std::size_t i = 0; i < kDimensions; ++i) header.size[i] = bytes.readAt<std::int64_t>(24 + 8 * i);
    for (std::size_t i = 0; i < 5; ++i) header.spacing[i] = bytes.readAt<double>(104 + 8 * i);
    header.dataAt = static_cast<double>(bytes.readAt<std::int64_t>(168));
    header.slope = bytes.readAt<double>(176);
    header.intercept = bytes.readAt<double>(184);
    header.firstTime = bytes.readAt<double>(216);
    header.qform = bytes.readAt<std::int32_t>(344);
    header.sform = bytes.readAt<std::int32_t>(348);
    for (std::size_t i = 0; i < 3; ++i) {
        header.quaternion[i] = bytes.readAt<double>(352 + 8 * i);
        header.offset[i] = bytes.readAt<double>(376 + 8 * i);
        for (std::size_t j = 0; j < 4; ++j) header.rows[i][j] = bytes.readAt<double>(400 + 32 * i + 8 * j);
    }
    header.units = bytes.readAt<std::int32_t>(500);
    header.quantity = bytes.textAt(508, 16);
    return header;
}

std::size_t headerSize(std::span<const std::byte> start) { return isBigEndian(start, kHeader1) ? kHeader1 : kHeader2; }

Result<NiftiHeader> parseHeader(std::span<const std::byte> start) {
    const std::size_t size = headerSize(start);
    const auto bigEndian = isBigEndian(start, size);
    if (!bigEndian) return badFieldError("the file is not in the format NIfTI");
    if (start.size() < size) return badFieldError("the header of the file is incomplete");
    const NiftiHeaderReader bytes(start, *bigEndian);
    const std::string magic = bytes.textAt(size == kHeader1 ? 344 : 4, 3);
    if (magic == "ni1" || magic == "ni2")
        return badFieldError("the header and the data are in two files; join them into one file .nii");
    if (magic != (size == kHeader1 ? "n+1" : "n+2")) return badFieldError("the file is not in the format NIfTI");
    NiftiHeader header = size == kHeader1 ? parseNifti1(bytes) : parseNifti2(bytes);
    header.bigEndian = *bigEndian;
    if (header.dimensions < 1 || header.dimensions > static_cast<std::int64_t>(kDimensions))
        return badFieldError("the array must have 1 to 4 dimensions");
    for (std::size_t i = 0; i < static_cast<std::size_t>(header.dimensions); ++i) {
        if (header.size[i] < 1) return badFieldError("the array is empty");
        if (i >= 4 && header.size[i] > 1)
            return badFieldError("the array has several numbers at each point, or more than 4 dimensions");
    }
    header.dimensions = std::min<std::int64_t>(header.dimensions, 4);
    if (!(header.dataAt >= static_cast<double>(size) && header.dataAt <= kMaxDataAt))
        return badFieldError("the header states an impossible position of the data");
    return header;
}

std::optional<StoredNumberFormat> niftiNumberFormatOf(const NiftiHeader& header) {
    static constexpr std::array<std::pair<int, NumberType>, 10> kNiftiTypes{{{2, NumberType::u1},
                                                                             {4, NumberType::i2},
                                                                             {8, NumberType::i4},
                                                                             {16, NumberType::f4},
                                                                             {64, NumberType::f8},
                                                                             {256, NumberType::i1},
                                                                             {512, NumberType::u2},
                                                                             {768, NumberType::u4},
                                                                             {1024, NumberType::i8},
                                                                             {1280, NumberType::u8}}};
    const auto* const type = std::find_if(kNiftiTypes.begin(), kNiftiTypes.end(),
                                          [&](const auto& each) { return each.first == header.type; });
    if (type == kNiftiTypes.end()) return {};
    StoredNumberFormat format;
    format.type = type->second;
    format.bigEndian = header.bigEndian;
    if (header.slope != 0 && std::isfinite(header.slope) && std::isfinite(header.intercept)) {
        format.scale = header.slope;
        format.offset = header.intercept;
    }
    return format;
}

double spacingAlong(const NiftiHeader& header, std::size_t dimension) {
    const double spacing = std::abs(header.spacing[dimension + 1]);
    return spacing > 0 && std::isfinite(spacing) ? spacing : 1;
}

using IndexToSpaceMatrix = std::array<std::array<double, 4>, 3>;  // maps the indices of a voxel to coordinates in space

// Returns the orientation of the image by method 3 of nifti1.h (sform) if the file has it, otherwise by method 2
// (qform). Returns an empty optional if the file has neither.
std::optional<IndexToSpaceMatrix> imageOrientation(const NiftiHeader& header) {
    if (header.sform > 0) return header.rows;
    if (header.qform <= 0) return {};
    const auto& [b, c, d] = header.quaternion;
    const double a = std::sqrt(std::max(0., 1 - b * b - c * c - d * d));
    IndexToSpaceMatrix matrix{{{a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)},
                               {2 * (b * c + a * d), a * a + c * c - b * b - d * d, 2 * (c * d - a * b)},
                               {2 * (b * d - a * c), 2 * (c * d + a * b), a * a + d * d - b * b - c * c}}};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j)
            matrix[i][j] *= spacingAlong(header, j) * (j == 2 && header.spacing[0] < 0 ? -1 : 1);
        matrix[i][3] = header.offset[i];
    }
    return matrix;
}

// Returns the axis of space to which each of the first three dimensions of the array is parallel. Returns an empty
// optional if one of these dimensions is oblique.
std::optional<std::array<std::size_t, 3>> parallelAxes(const IndexToSpaceMatrix& matrix) {
    constexpr double kTolerance = 1e-3;
    std::array<std::size_t, 3> axes{};
    for (std::size_t j = 0; j < 3; ++j) {
        const auto magnitude = [&](std::size_t i) { return std::abs(matrix[i][j]); };
        for (std::size_t i = 1; i < 3; ++i) {
            if (magnitude(i) > magnitude(axes[j])) axes[j] = i;
        }
        for (std::size_t i = 0; i < 3; ++i) {
            if (!std::isfinite(matrix[i][j]) || !std::isfinite(matrix[i][3]) || magnitude(axes[j]) == 0) return {};
            if (i != axes[j] && magnitude(i) > kTolerance * magnitude(axes[j])) return {};
        }
        for (std::size_t k = 0; k < j; ++k) {
            if (axes[k] == axes[j]) return {};
        }
    }
    return axes;
}

// Returns the units that the header states: a unit of length for the first three dimensions, and the unit of the
// fourth.
AxisUnits statedUnits(const NiftiHeader& header) {
    static constexpr std::array<std::string_view, 4> kLengths{"", "m", "mm", "µm"};
    static constexpr std::array<std::string_view, 7> kTimes{"", "s", "ms", "µs", "Hz", "ppm", "rad/s"};
    const auto length = static_cast<std::size_t>(header.units & 7),
               time = static_cast<std::size_t>(header.units >> 3 & 7);
    AxisUnits units;
    for (std::size_t i = 0; i < 3 && length < kLengths.size(); ++i) units.at(i) = kLengths.at(length);
    if (time < kTimes.size()) units[3] = kTimes.at(time);
    return units;
}

// Sets the box and the units of `field`, and the axes and directions of `dimensions`. The order of `dimensions` must be
// from the fastest to the slowest.
std::optional<Error> mapDimensions(const NiftiHeader& header, const FieldReadOptions& options,
                                   std::vector<ArrayDimension>& dimensions, FieldArray& field) {
    const AxisUnits units = statedUnits(header);
    field.units = units;
    const auto matrix = imageOrientation(header);
    auto parallel = matrix ? parallelAxes(*matrix) : std::nullopt;
    if (!options.axes.empty()) {
        auto axes = parseAxes(options.axes, dimensions.size());
        if (!axes) return axes.error();
        std::reverse(axes->begin(), axes->end());
        field.units = {};
        for (std::size_t i = 0; i < dimensions.size(); ++i) {
            dimensions[i].axis = (*axes)[i];
            field.units.at(dimensions[i].axis) = units.at(i);
        }
        parallel.reset();
    } else {
        for (std::size_t i = 0; i < dimensions.size(); ++i) dimensions[i].axis = i < 3 && parallel ? (*parallel)[i] : i;
        if (matrix && !parallel)
            field.warnings.emplace_back("the voxels are oblique to the axes of space; their own axes are used instead");
    }
    field.box = {glm::dvec4(0), glm::dvec4(0)};
    for (std::size_t i = 0; i < dimensions.size(); ++i) {
        const auto axis = static_cast<glm::length_t>(dimensions[i].axis);
        double length = spacingAlong(header, i) * static_cast<double>(dimensions[i].size - 1);
        double first = i == 3 ? (std::isfinite(header.firstTime) ? header.firstTime : 0) : -length / 2;
        if (parallel && i < 3) {
            const auto& row = (*matrix)[dimensions[i].axis];
            length = std::abs(row[i]) * static_cast<double>(dimensions[i].size - 1);
            dimensions[i].reversed = row[i] < 0;
            first = row[3] - (dimensions[i].reversed ? length : 0);
        }
        field.box.min[axis] = first;
        field.box.max[axis] = first + length;
    }
    if (options.box) field.box = *options.box;
    field.boxIsKnown = true;
    return {};
}

// Returns the first `size` decompressed bytes of `file`, a gzip file. `gzip` decompresses `file`; `unzipped` must
// contain the bytes that `gzip` has already returned. The result is in memory if it has at most 4 ·
// `options.maxInMemory` bytes, or if `options.newFile` is null. Otherwise, it is in a file that `options.newFile`
// makes.
Result<FileContents> gunzipFirst(const FileContents& file, GzipReader& gzip, std::vector<std::byte>& unzipped,
                                 std::size_t size, const FieldReadOptions& options) {
    constexpr std::size_t kPiece = std::size_t{64} << 20U;
    if (size / sizeof(float) <= options.maxInMemory || !options.newFile) {
        if (const auto read = gzip.extendTo(size, unzipped); !read) return read.error();
        return FileContents::ofBytes(std::move(unzipped));
    }
    auto to = options.newFile(size);
    if (!to) return to.error();
    const std::span<std::byte> bytes = (*to)->writableBytes();
    std::copy(unzipped.begin(), unzipped.end(), bytes.begin());
    for (std::size_t done = unzipped.size(); done < size; done += kPiece) {
        if (const auto read = gzip.decompressInto(bytes.subspan(done, std::min(kPiece, size - done))); !read)
            return read.error();
        file.releasePages();
        (*to)->releasePages();
    }
    return FileContents::ofMappedFile(MappedFilePtr(std::move(*to)));
}

// Returns the stored numbers, which take `size` bytes from the byte `begin` on. They are bytes of `file` if `gzip` is
// null, otherwise of the decompressed contents of `file`. For `gzip` and `unzipped`, see gunzipFirst().
Result<FileContents> sampleBytesIn(const FileContents& file, GzipReader* gzip, std::vector<std::byte>& unzipped,
                                   std::size_t begin, std::size_t size, const FieldReadOptions& options) {
    if (gzip != nullptr) {
        auto contents = gunzipFirst(file, *gzip, unzipped, begin + size, options);
        if (contents) contents->bytes = contents->bytes.subspan(begin);
        return contents;
    }
    if (file.bytes.size() < begin || file.bytes.size() - begin < size) {
        return badFieldError("the array should take " + std::to_string(size) + " bytes from byte " +
                             std::to_string(begin) + " on, but the file has only " + std::to_string(file.bytes.size()));
    }
    FileContents contents = file;
    contents.bytes = file.bytes.subspan(begin, size);
    return contents;
}

}  // namespace

bool isNiftiStart(std::span<const std::byte> start) {
    const std::size_t size = headerSize(start);
    const auto bigEndian = isBigEndian(start, size);
    if (!bigEndian || start.size() < kHeader1) return false;
    const std::string magic = NiftiHeaderReader(start, *bigEndian).textAt(size == kHeader1 ? 344 : 4, 3);
    return magic == "n+1" || magic == "n+2" || magic == "ni1" || magic == "ni2";
}

Result<FieldArray> readNifti(const FileContents& file, const FieldReadOptions& options) {
    std::vector<std::byte> unzipped;
    std::optional<GzipReader> gzip;
    if (isGzipStart(file.bytes)) {
        gzip.emplace(file.bytes);
        const auto begun = gzip->extendTo(kHeader1, unzipped);
        const auto isEmpty = [&] {
            return std::ranges::all_of(unzipped, [](std::byte b) { return b == std::byte{}; });
        };
        const bool isNifti = isBigEndian(unzipped, kHeader1) || isBigEndian(unzipped, kHeader2);
        if (!isNifti && (begun || !isEmpty()))
            return badFieldError("the file is compressed with gzip and contains no NIfTI image; unpack it first");
        if (!begun) return begun.error();
        if (headerSize(unzipped) == kHeader2) {
            if (const auto read = gzip->extendTo(kHeader2, unzipped); !read) return read.error();
        }
    }
    const auto header = parseHeader(gzip ? std::span<const std::byte>(unzipped) : file.bytes);
    if (!header) return header.error();
    const auto format = niftiNumberFormatOf(*header);
    if (!format)
        return badFieldError("the numbers are of the type " + std::to_string(header->type) +
                             " of NIfTI; they must be real");

    FieldArray field;
    std::vector<ArrayDimension> dimensions(static_cast<std::size_t>(header->dimensions));
    for (std::size_t i = 0; i < dimensions.size(); ++i) dimensions[i].size = static_cast<std::size_t>(header->size[i]);
    if (auto error = mapDimensions(*header, options, dimensions, field)) return *error;
    std::reverse(dimensions.begin(), dimensions.end());
    const auto mapping = AxisMapping::fromDimensions(dimensions, options.maxSamples);
    if (!mapping) return mapping.error();
    const auto data = sampleBytesIn(file, gzip ? &*gzip : nullptr, unzipped, static_cast<std::size_t>(header->dataAt),
                                    mapping->count() * sizeOf(format->type), options);
    if (!data) return data.error();
    field.shape = mapping->shape();
    auto samples = mapping->samples(*data, data->bytes, *format, options);
    if (!samples) return samples.error();
    field.samples = std::move(*samples);
    field.quantity.name = header->quantity;
    return field;
}

}  // namespace oval4d::fields
