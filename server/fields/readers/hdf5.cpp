#include "fields/readers/hdf5.hpp"

#define H5_USE_110_API  // declares the functions of HDF5 1.10, which later versions have, too
#include <hdf5.h>

#include <algorithm>
#include <array>
#include <bit>
#include <exception>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fields/readers/axis_mapping.hpp"
#include "fields/readers/netcdf.hpp"
#include "fields/readers/sample_buffer.hpp"
#include "text/message_text.hpp"

namespace oval4d::fields {

namespace {

constexpr std::size_t kMaxDatasets = 10'000;  // a file with this many datasets or more is an error

// The identifier of an object of the HDF5 library. The destructor closes the object.
class Hdf5Handle {
  public:
    Hdf5Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
    ~Hdf5Handle() {
        if (id_ >= 0) close_(id_);
    }
    Hdf5Handle(const Hdf5Handle&) = delete;
    Hdf5Handle& operator=(const Hdf5Handle&) = delete;

    explicit operator bool() const { return id_ >= 0; }
    hid_t operator*() const { return id_; }

  private:
    hid_t id_;
    herr_t (*close_)(hid_t);
};

// The functions that the HDF5 library calls to get memory for a copy of the file and to fill it. To avoid the copy, the
// functions return the file's own bytes. The library does not write to these bytes, because it opens the file only for
// reading.
void* useFileBytes(std::size_t /*size*/, H5FD_file_image_op_t /*purpose*/, void* bytes) { return bytes; }
void* copyNothing(void* to, const void* from, std::size_t /*size*/, H5FD_file_image_op_t /*purpose*/, void* /*bytes*/) {
    return to == from ? to : nullptr;
}
void* refuseToGrow(void* /*memory*/, std::size_t /*size*/, H5FD_file_image_op_t /*purpose*/, void* /*bytes*/) {
    return nullptr;
}
herr_t ignoreImageFree(void* /*memory*/, H5FD_file_image_op_t /*purpose*/, void* /*bytes*/) { return 0; }
void* shareUserData(void* bytes) { return bytes; }
herr_t ignoreUserDataFree(void* /*bytes*/) { return 0; }

// Opens a file that is in memory. Returns a negative number if the file is not valid. Does not use H5LTopen_file_image,
// which leaks memory if the file is not valid.
hid_t openFileInMemory(std::span<const std::byte> bytes) {
    constexpr std::size_t kIncrement = 65536;                   // the number of bytes by which the library would let
                                                                // the file grow
    auto* const memory = const_cast<std::byte*>(bytes.data());  // the library does not write to the bytes, although its
                                                                // type is not const
    H5FD_file_image_callbacks_t callbacks{useFileBytes,  copyNothing,        refuseToGrow, ignoreImageFree,
                                          shareUserData, ignoreUserDataFree, memory};
    const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    if (!access || H5Pset_fapl_core(*access, kIncrement, false) < 0 ||
        H5Pset_file_image_callbacks(*access, &callbacks) < 0 || H5Pset_file_image(*access, memory, bytes.size()) < 0) {
        return -1;
    }
    return H5Fopen("field", H5F_ACC_RDONLY, *access);
}

struct Hdf5DatasetListing {
    std::vector<std::string> datasets;
    bool refers = false;     // whether a link or a dataset refers to another file
    bool hasScales = false;  // whether a dataset has dimension scales, as all variables of NetCDF-4 files have
};

// The HDF5 library calls recordIfExternalLink() for each link in the file, and recordIfDataset() for each object, until
// a call returns a number other than 0. The two functions must not throw, because the library is written in C.
herr_t recordIfExternalLink(hid_t /*group*/, const char* /*name*/, const H5L_info_t* info, void* to) noexcept {
    auto& contents = *static_cast<Hdf5DatasetListing*>(to);
    contents.refers = contents.refers || info->type > H5L_TYPE_SOFT;
    return contents.refers ? 1 : 0;
}

herr_t recordIfDataset(hid_t file, const char* name, const H5O_info_t* info, void* to) noexcept {
    auto& contents = *static_cast<Hdf5DatasetListing*>(to);
    if (info->type != H5O_TYPE_DATASET) return 0;
    try {
        contents.datasets.emplace_back(name);
        const Hdf5Handle dataset(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose);
        if (!dataset) return 0;
        contents.hasScales = contents.hasScales || H5Aexists(*dataset, "DIMENSION_LIST") > 0;
        const Hdf5Handle creation(H5Dget_create_plist(*dataset), H5Pclose);
        if (!creation) return 0;
        contents.refers =
            contents.refers || H5Pget_layout(*creation) == H5D_VIRTUAL || H5Pget_external_count(*creation) > 0;
        return contents.refers || contents.datasets.size() == kMaxDatasets ? 1 : 0;
    } catch (const std::exception&) {
        return -1;
    }
}

std::optional<std::vector<std::size_t>> sizeOfDataset(hid_t dataset) {
    const Hdf5Handle space(H5Dget_space(dataset), H5Sclose);
    if (!space || H5Sget_simple_extent_type(*space) != H5S_SIMPLE) return {};
    std::array<hsize_t, H5S_MAX_RANK> size{};
    const int dimensions = H5Sget_simple_extent_dims(*space, size.data(), nullptr);
    if (dimensions < 1) return {};
    return std::vector<std::size_t>(size.begin(), size.begin() + dimensions);
}

// Returns whether an HDF5 type is that of IEEE 754 floats of two bytes, as h5py writes them. Before version 1.14.4, the
// HDF5 library has no name for this type.
bool isHalfPrecision(hid_t type) {
    std::size_t sign = 0, exponent = 0, exponentBits = 0, fraction = 0, fractionBits = 0;
    const H5T_order_t order = H5Tget_order(type);
    return H5Tget_size(type) == 2 && (order == H5T_ORDER_LE || order == H5T_ORDER_BE) &&
           H5Tget_fields(type, &sign, &exponent, &exponentBits, &fraction, &fractionBits) >= 0 && sign == 15 &&
           exponent == 10 && exponentBits == 5 && fraction == 0 && fractionBits == 10 && H5Tget_ebias(type) == 15 &&
           H5Tget_norm(type) == H5T_NORM_IMPLIED && H5Tget_offset(type) == 0 && H5Tget_precision(type) == 16;
}

// Returns how a file stores numbers of this HDF5 type. Returns an empty optional if the type is not one of NumberType.
std::optional<StoredNumberFormat> hdf5NumberFormatOf(hid_t type) {
    static constexpr std::array kSigned{NumberType::i1, NumberType::i2, NumberType::i4, NumberType::i8};
    static constexpr std::array kUnsigned{NumberType::u1, NumberType::u2, NumberType::u4, NumberType::u8};
    const H5T_class_t kind = H5Tget_class(type);
    const std::size_t size = H5Tget_size(type);
    StoredNumberFormat format;
    format.bigEndian = H5Tget_order(type) == H5T_ORDER_BE;
    if (kind == H5T_FLOAT) {
        const std::array<std::pair<hid_t, NumberType>, 4> floats{{{H5T_IEEE_F32LE, NumberType::f4},
                                                                  {H5T_IEEE_F32BE, NumberType::f4},
                                                                  {H5T_IEEE_F64LE, NumberType::f8},
                                                                  {H5T_IEEE_F64BE, NumberType::f8}}};
        for (const auto& [known, number] : floats) {
            if (H5Tequal(type, known) <= 0) continue;
            format.type = number;
            return format;
        }
        if (!isHalfPrecision(type)) return {};
        format.type = NumberType::f2;
        return format;
    }
    if (kind == H5T_ENUM) {  // h5py stores Booleans as an enumeration: FALSE is 0, TRUE is 1
        const Hdf5Handle base(H5Tget_super(type), H5Tclose);
        if (size != 1 || H5Tget_nmembers(type) != 2 || H5Tget_member_index(type, "TRUE") < 0) return {};
        format.type = NumberType::boolean;
        return format;
    }
    if (kind != H5T_INTEGER || !std::has_single_bit(size) || size > 8 || H5Tget_precision(type) != 8 * size) return {};
    const auto place = static_cast<std::size_t>(std::countr_zero(size));
    format.type = H5Tget_sign(type) == H5T_SGN_NONE ? kUnsigned.at(place) : kSigned.at(place);
    return format;
}

// Returns the `size` bytes of a dataset in the file. Returns an empty optional unless the dataset is stored in one
// piece, without filters, in this file.
std::optional<std::span<const std::byte>> contiguousDatasetBytes(const FileContents& file, hid_t dataset,
                                                                 std::size_t size) {
    const Hdf5Handle creation(H5Dget_create_plist(dataset), H5Pclose);
    if (!creation || H5Pget_layout(*creation) != H5D_CONTIGUOUS) return {};
    const haddr_t offset = H5Dget_offset(dataset);
    if (!isHdf5Start(file.bytes) || offset == HADDR_UNDEF || offset > file.bytes.size() ||
        file.bytes.size() - offset < size || H5Dget_storage_size(dataset) < size) {
        return {};
    }
    return file.bytes.subspan(offset, size);
}

// Reads the dataset slab by slab, and converts its numbers to samples. `stored` is the HDF5 type of the numbers. `kept`
// are the dimensions that `mapping` maps to axes (see squeezedDimensionIndices()); all other dimensions have the
// size 1.
Result<SampleStorage> readSlabs(const FileContents& file, const FieldReadOptions& options, hid_t dataset, hid_t stored,
                                const std::vector<std::size_t>& kept, const AxisMapping& mapping,
                                const StoredNumberFormat& format) {
    const Hdf5Handle space(H5Dget_space(dataset), H5Sclose);
    const auto dimensions = static_cast<std::size_t>(H5Sget_simple_extent_ndims(*space));
    std::vector<hsize_t> start(dimensions, 0), size(dimensions, 1);
    auto buffer = SampleBuffer::allocate(mapping.count(), options);
    if (!buffer) return buffer.error();
    std::vector<std::byte> numbers;
    for (const Slab& slab : mapping.slabs(kSlabSize)) {
        hsize_t count = 1;
        for (std::size_t i = 0; i < kept.size(); ++i) {
            const std::size_t at = 4 - kept.size() + i;  // a slab has leading dimensions of size 1
            start[kept[i]] = slab.start.at(at);
            size[kept[i]] = slab.layout.size.at(at);
            count *= size[kept[i]];
        }
        const Hdf5Handle memory(H5Screate_simple(1, &count, nullptr), H5Sclose);
        numbers.resize(count * sizeOf(format.type));
        if (H5Sselect_hyperslab(*space, H5S_SELECT_SET, start.data(), nullptr, size.data(), nullptr) < 0 ||
            H5Dread(dataset, stored, *memory, *space, H5P_DEFAULT, numbers.data()) < 0) {
            return badFieldError(
                "the dataset cannot be read: it is damaged, or it is compressed in a way that is not supported");
        }
        convertToFloats(format, numbers.data(), slab.layout, buffer->values().data() + slab.first);
        file.releasePages();
        buffer->releasePages();
    }
    return buffer->takeSamples();
}

// Chooses a dataset among the candidates, that is, the datasets of numbers with 1 to 4 dimensions (see
// squeezedDimensionIndices()). Returns the path of the candidate with the most dimensions, the first of several such
// candidates. Returns an empty string if there is no candidate. Adds a warning if there are several candidates.
std::string defaultDataset(hid_t file, const std::vector<std::string>& datasets, std::vector<std::string>& warnings) {
    std::string chosen;
    std::size_t dimensions = 0, candidates = 0;
    for (const std::string& name : datasets) {
        const Hdf5Handle dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
        if (!dataset) continue;
        const Hdf5Handle type(H5Dget_type(*dataset), H5Tclose);
        const auto size = sizeOfDataset(*dataset);
        if (!type || !size || !hdf5NumberFormatOf(*type)) continue;
        const std::size_t kept = squeezedDimensionIndices(*size).size();
        if (kept > 4) continue;
        ++candidates;
        if (kept <= dimensions) continue;
        dimensions = kept;
        chosen = name;
    }
    if (candidates > 1)
        warnings.push_back("of " + std::to_string(candidates) + " datasets, " + text::inQuotes(chosen) + " is shown");
    return chosen;
}

// Returns an attribute of a dataset as sanitizeQuantityText() returns it. Returns an empty string if the dataset has no
// such attribute, or if the attribute is not a single text.
std::string textOfAttribute(hid_t dataset, const char* attribute) {
    constexpr std::size_t kMost = 65536;  // the size in bytes of the largest text that is read
    if (H5Aexists(dataset, attribute) <= 0) return {};
    const Hdf5Handle found(H5Aopen(dataset, attribute, H5P_DEFAULT), H5Aclose);
    if (!found) return {};
    const Hdf5Handle type(H5Aget_type(*found), H5Tclose);
    const Hdf5Handle space(H5Aget_space(*found), H5Sclose);
    if (!type || !space || H5Tget_class(*type) != H5T_STRING || H5Sget_simple_extent_npoints(*space) != 1) return {};
    if (H5Tis_variable_str(*type) > 0) {
        char* read = nullptr;
        if (H5Aread(*found, *type, static_cast<void*>(&read)) < 0 || read == nullptr) return {};
        std::string text = sanitizeQuantityText(read);
        H5free_memory(read);
        return text;
    }
    std::string text(std::min(H5Tget_size(*type), kMost + 1), '\0');
    if (text.empty() || text.size() > kMost || H5Aread(*found, *type, text.data()) < 0) return {};
    text.resize(std::min(text.find('\0'), text.size()));
    text.resize(text.find_last_not_of(' ') + 1);  // Fortran pads texts with blanks
    return sanitizeQuantityText(text);
}

Result<FieldArray> readDataset(const FileContents& file, hid_t id, const std::vector<std::string>& datasets,
                               const FieldReadOptions& options) {
    FieldArray field;
    std::string name = options.variable;
    if (name.empty()) name = defaultDataset(id, datasets, field.warnings);
    if (name.empty()) return badFieldError("the file has no dataset of real numbers with 1 to 4 dimensions");
    // `name` may be a path with soft links, which is not in `datasets`. No path leads out of this file, because
    // readHdf5() does not accept files with external links.
    const bool isPath = !name.ends_with('/') && name.find('\0') == std::string::npos;
    const Hdf5Handle access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
    if (access) H5Pset_chunk_cache(*access, H5D_CHUNK_CACHE_NSLOTS_DEFAULT, kChunkCacheSize, 1);
    const Hdf5Handle dataset(isPath ? H5Dopen2(id, name.c_str(), access ? *access : H5P_DEFAULT) : -1, H5Dclose);
    if (!dataset) {
        const std::vector<std::string_view> names(datasets.begin(), datasets.end());
        return Error{ErrorCode::not_found,
                     "the file has no dataset " + text::inQuotes(name) + text::didYouMean(name, names)};
    }
    const Hdf5Handle type(H5Dget_type(*dataset), H5Tclose);
    const auto format = type ? hdf5NumberFormatOf(*type) : std::nullopt;
    const auto size = sizeOfDataset(*dataset);
    if (!format || !size)
        return badFieldError("the dataset " + text::inQuotes(name) + " is not an array of real numbers");
    const std::vector<std::size_t> kept = squeezedDimensionIndices(*size);
    const auto axes = parseAxes(options.axes, kept.size());
    if (!axes) return axes.error();
    std::vector<ArrayDimension> dimensions;
    for (std::size_t i = 0; i < kept.size(); ++i) dimensions.push_back({(*size)[kept[i]], (*axes)[i]});
    const auto mapping = AxisMapping::fromDimensions(dimensions, options.maxSamples);
    if (!mapping) return mapping.error();
    field.shape = mapping->shape();
    field.boxIsKnown = options.box.has_value();
    const bool time = options.axes.empty() || options.axes.find('t') != std::string::npos;
    field.box = options.box.value_or(defaultBox(field.shape, time));
    field.quantity = {textOfAttribute(*dataset, "long_name"), textOfAttribute(*dataset, "units")};
    if (field.quantity.name.empty()) field.quantity.name = sanitizeQuantityText(name.substr(name.rfind('/') + 1));
    if (const auto bytes = contiguousDatasetBytes(file, *dataset, mapping->count() * sizeOf(format->type))) {
        auto inPlace = mapping->samples(file, *bytes, *format, options);
        if (!inPlace) return inPlace.error();
        field.samples = std::move(*inPlace);
        return field;
    }
    auto samples = readSlabs(file, options, *dataset, *type, kept, *mapping, *format);
    if (!samples) return samples.error();
    field.samples = *samples;
    return field;
}

}  // namespace

bool isHdf5Start(std::span<const std::byte> start) {
    return std::string_view(reinterpret_cast<const char*>(start.data()), start.size()).starts_with("\x89HDF\r\n\x1a\n");
}

Result<FieldArray> readHdf5(const FileContents& file, const FieldReadOptions& options) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // the library prints no messages
    H5PLset_loading_state(0);                     // the library loads no plug-ins
    const Hdf5Handle id(openFileInMemory(file.bytes), H5Fclose);
    if (!id) return badFieldError("the file is not a valid HDF5 file");
    Hdf5DatasetListing contents;
    const bool visited =
        H5Lvisit(*id, H5_INDEX_NAME, H5_ITER_INC, recordIfExternalLink, &contents) >= 0 &&
        (contents.refers || H5Ovisit(*id, H5_INDEX_NAME, H5_ITER_INC, recordIfDataset, &contents) >= 0);
    if (!visited) return badFieldError("the file is not a valid HDF5 file: its groups cannot be read");
    if (contents.refers) {
        return badFieldError(
            "the file refers to other files, which are not read: it has external links, external storage or virtual "
            "datasets");
    }
    if (contents.datasets.size() == kMaxDatasets) return badFieldError("the file has too many datasets");
    if (H5Aexists(*id, "_NCProperties") > 0) return readNetcdf(file, options);
    // A file with dimension scales but without _NCProperties is from NetCDF before version 4.4.1, or from another
    // program. The NetCDF library may not know the types that another program uses. If it fails, readDataset() reads
    // the file.
    if (contents.hasScales) {
        if (auto field = readNetcdf(file, options)) return field;
    }
    return readDataset(file, *id, contents.datasets, options);
}

}  // namespace oval4d::fields
