// The same array in all formats, as the formats' own libraries write them.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <netcdf.h>
#include <nifti1_io.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <memory>
#include <stdexcept>
#include <utility>

#include "fields/readers/field_reader.hpp"
#include "fields/readers/hdf5.hpp"
#include "fields/readers/netcdf.hpp"
#include "fields/readers/nifti.hpp"
#include "unit/fields/array/random_arrays.hpp"
#include "unit/fields/readers/files.hpp"

namespace oval4d::fields::test {
namespace {

constexpr Shape kShape{5, 4, 3, 2};  // nx, ny, nz, nw
constexpr std::size_t kCount = 120;

std::vector<float> numbers() {
    std::mt19937 random(1);
    auto samples = randomSamples(kShape, 0, random);
    samples[7] = std::numeric_limits<float>::quiet_NaN();
    return samples;
}

std::vector<std::uint32_t> bitsOf(const FieldArray& field) {
    std::vector<std::uint32_t> bits;
    for (const float sample : field.samples.values()) bits.push_back(std::bit_cast<std::uint32_t>(sample));
    return bits;
}

FieldArray readOrFail(const std::string& bytes, const ReadOptions& options = {}) {
    auto field = readField(FileContents::copyOf(bytes), options);
    if (!field) throw std::runtime_error(field.error().message);
    return *field;
}

void check(int status) { ASSERT_EQ(status, NC_NOERR) << nc_strerror(status); }

// A variable f(t, z, y, x) of floats. `mode` is NC_NETCDF4, NC_64BIT_DATA …
std::string netcdf(int mode, const std::vector<float>& samples) {
    const TemporaryFolder folder;
    const std::string path = (folder / "a.nc").string();
    int file = 0, variable = 0;
    check(nc_create(path.c_str(), mode | NC_CLOBBER, &file));
    std::array<int, 4> dimensions{};
    const std::array<const char*, 4> names{"t", "z", "y", "x"};
    for (std::size_t i = 0; i < 4; ++i) check(nc_def_dim(file, names[i], kShape[3 - i], &dimensions[i]));
    check(nc_def_var(file, "f", NC_FLOAT, 4, dimensions.data(), &variable));
    check(nc_enddef(file));
    check(nc_put_var_float(file, variable, samples.data()));
    check(nc_close(file));
    return readFile(path);
}

struct Hdf5Options {
    bool compressed = false, bigEndian = false, external = false, softLinks = false;
};

std::string hdf5(const std::vector<float>& samples, const Hdf5Options& options = {}) {
    const TemporaryFolder folder;
    const std::string path = (folder / "a.h5").string();
    const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t group = H5Gcreate2(file, "run", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    const std::array<hsize_t, 4> size{kShape[3], kShape[2], kShape[1], kShape[0]}, chunk{1, 2, 4, 3};
    const hid_t space = H5Screate_simple(4, size.data(), nullptr), list = H5Pcreate(H5P_DATASET_CREATE);
    if (options.compressed) {
        H5Pset_chunk(list, 4, chunk.data());
        H5Pset_deflate(list, 5);
    }
    if (options.external) H5Pset_external(list, "/etc/passwd", 0, kCount * sizeof(float));
    const hid_t dataset = H5Dcreate2(group, "f", options.bigEndian ? H5T_IEEE_F32BE : H5T_IEEE_F32LE, space,
                                     H5P_DEFAULT, list, H5P_DEFAULT);
    if (!options.external) H5Dwrite(dataset, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, samples.data());
    if (options.softLinks) {
        for (const auto& [target, name] : {std::pair{"/run/f", "latest"},
                                           {"/run", "last"},
                                           {"latest", "twice"},
                                           {"/nothing", "dangling"},
                                           {"circular", "circular"}})
            H5Lcreate_soft(target, file, name, H5P_DEFAULT, H5P_DEFAULT);
    }
    H5Dclose(dataset);
    H5Pclose(list);
    H5Sclose(space);
    H5Gclose(group);
    H5Fclose(file);
    return readFile(path);
}

// Numbers of IEEE 754 binary16, as h5py writes them.
std::string hdf5OfHalves(std::vector<std::uint16_t> bits, bool bigEndian) {
    const TemporaryFolder folder;
    const std::string path = (folder / "a.h5").string();
    const hid_t type = H5Tcopy(bigEndian ? H5T_IEEE_F32BE : H5T_IEEE_F32LE);
    H5Tset_fields(type, 15, 10, 5, 0, 10);
    H5Tset_size(type, 2);
    H5Tset_ebias(type, 15);
    if (bigEndian != (std::endian::native == std::endian::big)) {
        for (std::uint16_t& each : bits) each = static_cast<std::uint16_t>(each >> 8U | each << 8U);
    }
    const hsize_t size = bits.size();
    const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t space = H5Screate_simple(1, &size, nullptr);
    const hid_t dataset = H5Dcreate2(file, "f", type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bits.data());
    H5Dclose(dataset);
    H5Sclose(space);
    H5Fclose(file);
    H5Tclose(type);
    return readFile(path);
}

// `changed` changes the header before the file is written.
std::string nifti(const std::string& name, const std::vector<float>& samples,
                  const std::function<void(nifti_image&)>& changed = {}) {
    const TemporaryFolder folder;
    const std::string path = (folder / name).string();
    const std::array<int, 8> size{4, 5, 4, 3, 2, 1, 1, 1};
    nifti_image* const image = nifti_make_new_nim(size.data(), DT_FLOAT32, 1);
    std::memcpy(image->data, samples.data(), kCount * sizeof(float));
    nifti_set_filenames(image, path.c_str(), 0, 0);
    if (changed) changed(*image);
    nifti_image_write(image);
    nifti_image_free(image);
    return readFile(path);
}

std::string npyOf(const std::vector<float>& samples) { return npy("(2, 3, 4, 5)", samples); }

TEST(FieldFormats, GiveTheSameBits) {
    const auto samples = numbers();
    const auto expected = bitsOf(readOrFail(npyOf(samples)));
    ASSERT_EQ(expected.size(), kCount);
    const std::vector<std::pair<std::string, std::string>> files{
        {"netcdf", netcdf(0, samples)},
        {"netcdf", netcdf(NC_64BIT_OFFSET, samples)},
        {"netcdf", netcdf(NC_64BIT_DATA, samples)},
        {"hdf5", netcdf(NC_NETCDF4, samples)},
        {"hdf5", hdf5(samples)},
        {"hdf5", hdf5(samples, {.compressed = true})},
        {"hdf5", hdf5(samples, {.bigEndian = true})},
        {"nifti", nifti("a.nii", samples)},
        {"nifti", nifti("a.nii.gz", samples)},
    };
    for (const auto& [name, bytes] : files) {
        const auto file = FileContents::copyOf(bytes);
        const FieldFormat* const format = formatOfFile(file.bytes);
        ASSERT_NE(format, nullptr);
        EXPECT_EQ(format->name, name);
        const auto field = readOrFail(bytes);
        EXPECT_EQ(field.shape, kShape) << name;
        EXPECT_EQ(bitsOf(field), expected) << name;
        EXPECT_TRUE(field.warnings.empty()) << name << ": " << field.warnings.front();
        EXPECT_TRUE(field.function());
    }
}

TEST(FieldFormats, RejectOtherFiles) {
    for (const std::string bytes : {"", "4OFF\n5 10 10 5\n", "\x89PNG\r\n\x1a\n", "CDF", "CDF\x07", "\x93NUMP"}) {
        const auto field = readField(FileContents::copyOf(bytes), {});
        ASSERT_FALSE(field);
        EXPECT_EQ(field.error().code, ErrorCode::unsupported_format);
    }
}

TEST(Netcdf, FollowsTheConventions) {
    const TemporaryFolder folder;
    const std::string path = (folder / "a.nc").string();
    int file = 0;
    check(nc_create(path.c_str(), NC_CLOBBER | NC_NETCDF4, &file));
    const std::array<const char*, 4> names{"lon", "hours", "latitude", "nv"};
    const std::array<std::size_t, 4> sizes{4, 3, 2, 2};
    std::array<int, 4> dimensions{};
    std::array<int, 3> coordinates{};
    for (std::size_t i = 0; i < 4; ++i) check(nc_def_dim(file, names[i], sizes[i], &dimensions[i]));
    for (std::size_t i = 0; i < 3; ++i)
        check(nc_def_var(file, names[i], NC_DOUBLE, 1, &dimensions[i], &coordinates[i]));
    const auto setText = [&](int variable, const char* name, const std::string& text) {
        check(nc_put_att_text(file, variable, name, text.size(), text.c_str()));
    };
    setText(coordinates[0], "units", "degrees_east");
    setText(coordinates[1], "units", "hours since 2020-01-01");
    setText(coordinates[2], "standard_name", "latitude");
    setText(coordinates[2], "bounds", "latitude_bounds");
    int bounds = 0, variable = 0;
    const std::array<int, 2> ofBounds{dimensions[2], dimensions[3]};
    check(nc_def_var(file, "latitude_bounds", NC_DOUBLE, 2, ofBounds.data(), &bounds));
    check(nc_def_var(file, "sst", NC_SHORT, 3, dimensions.data(), &variable));
    setText(variable, "long_name", "sea surface temperature");
    setText(variable, "units", "K");
    const short fill = -999, range[2] = {-500, 100};
    const double scale = 0.01, offset = 273.15;
    check(nc_put_att_short(file, variable, "_FillValue", NC_SHORT, 1, &fill));
    check(nc_put_att_short(file, variable, "valid_range", NC_SHORT, 2, range));
    check(nc_put_att_double(file, variable, "scale_factor", NC_DOUBLE, 1, &scale));
    check(nc_put_att_double(file, variable, "add_offset", NC_DOUBLE, 1, &offset));
    check(nc_enddef(file));
    const std::array<double, 4> lon{10, 20, 30, 40};
    const std::array<double, 3> hours{0, 6, 12};
    const std::array<double, 2> latitude{50, 40};  // from north to south
    check(nc_put_var_double(file, coordinates[0], lon.data()));
    check(nc_put_var_double(file, coordinates[1], hours.data()));
    check(nc_put_var_double(file, coordinates[2], latitude.data()));
    std::array<short, 24> stored{};
    for (std::size_t i = 0; i < 24; ++i) stored[i] = static_cast<short>(i);
    stored[3] = fill;
    stored[4] = 101;
    check(nc_put_var_short(file, variable, stored.data()));
    check(nc_close(file));

    const auto field = readOrFail(readFile(path));
    EXPECT_EQ(field.shape, (Shape{4, 2, 1, 3}));
    EXPECT_EQ(field.box, (Box{{10, 40, 0, 0}, {40, 50, 0, 12}}));
    EXPECT_TRUE(field.boxIsKnown);
    EXPECT_EQ(field.units, (std::array<std::string, 4>{"degrees_east", "", "", "hours since 2020-01-01"}));
    EXPECT_EQ(field.quantity.name, "sea surface temperature");
    EXPECT_EQ(field.quantity.unit, "K");
    EXPECT_TRUE(field.warnings.empty()) << field.warnings.front();
    for (std::size_t x = 0; x < 4; ++x) {
        for (std::size_t t = 0; t < 3; ++t) {
            for (std::size_t y = 0; y < 2; ++y) {
                const short number = stored.at((x * 3 + t) * 2 + (1 - y));  // y is reversed
                const float sample = field.samples.values()[x + 4 * (y + 2 * t)];
                if (number == fill || number > 100)
                    EXPECT_TRUE(std::isnan(sample));
                else
                    EXPECT_EQ(sample, static_cast<float>(number * scale + offset));
            }
        }
    }
    EXPECT_EQ(readOrFail(readFile(path), {.axes = "xyz"}).shape, (Shape{4, 3, 2, 1}));
    EXPECT_EQ(readOrFail(readFile(path), {.variable = "/hours"}).shape, (Shape{1, 1, 1, 3}));
    const auto missing = readField(FileContents::copyOf(readFile(path)), {.variable = "salinity"});
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, ErrorCode::not_found);
}

TEST(Netcdf, ANameAloneMakesNoCoordinates) {
    const std::array<float, 2> samples{1, 2};
    const TemporaryFolder folder;
    const std::string path = (folder / "a.nc").string();
    int file = 0, x = 0, other = 0, variable = 0, coordinate = 0;
    check(nc_create(path.c_str(), NC_CLOBBER, &file));
    check(nc_def_dim(file, "x", 2, &x));
    check(nc_def_dim(file, "n", 100'000, &other));
    check(nc_def_var(file, "f", NC_FLOAT, 1, &x, &variable));
    check(nc_def_var(file, "x", NC_DOUBLE, 1, &other, &coordinate));
    check(nc_enddef(file));
    check(nc_put_var_float(file, variable, samples.data()));
    check(nc_close(file));
    const auto field = readOrFail(readFile(path), {.variable = "f"});
    EXPECT_EQ(field.shape, (Shape{2, 1, 1, 1}));
    EXPECT_FALSE(field.boxIsKnown);
}

TEST(Netcdf, TheDimensionOfAGroupIsNotTheOuterOneOfTheSameName) {
    const std::array<float, 2> samples{1, 2};
    const TemporaryFolder folder;
    const std::string path = (folder / "a.nc").string();
    int file = 0, group = 0, outer = 0, inner = 0, variable = 0, coordinate = 0;
    check(nc_create(path.c_str(), NC_CLOBBER | NC_NETCDF4, &file));
    check(nc_def_dim(file, "x", 2, &outer));
    check(nc_def_grp(file, "g", &group));
    check(nc_def_dim(group, "x", 100'000, &inner));
    check(nc_def_var(group, "f", NC_FLOAT, 1, &outer, &variable));
    check(nc_def_var(group, "x", NC_DOUBLE, 1, &inner, &coordinate));
    check(nc_enddef(file));
    check(nc_put_var_float(group, variable, samples.data()));
    check(nc_close(file));
    const auto field = readOrFail(readFile(path), {.variable = "g/f"});
    EXPECT_EQ(field.shape, (Shape{2, 1, 1, 1}));
    EXPECT_FALSE(field.boxIsKnown);
}

TEST(Netcdf, VariablesAndCoordinatesMayBeInGroups) {
    const std::array<float, 6> samples{1, 2, 3, 4, 5, 6};
    const std::array<double, 3> at{10, 20, 30};
    const TemporaryFolder folder;
    const std::string path = (folder / "a.nc").string();
    int file = 0, outer = 0, inner = 0, coordinate = 0, flat = 0, variable = 0;
    std::array<int, 2> dimensions{};
    check(nc_create(path.c_str(), NC_CLOBBER | NC_NETCDF4, &file));
    check(nc_def_dim(file, "y", 2, &dimensions[0]));
    check(nc_def_dim(file, "x", 3, &dimensions[1]));
    check(nc_def_grp(file, "run", &outer));
    check(nc_def_grp(outer, "last", &inner));
    check(nc_def_var(file, "x", NC_DOUBLE, 1, &dimensions[1], &coordinate));
    check(nc_def_var(outer, "mean", NC_FLOAT, 1, &dimensions[1], &flat));
    check(nc_def_var(inner, "f", NC_FLOAT, 2, dimensions.data(), &variable));
    check(nc_enddef(file));
    check(nc_put_var_double(file, coordinate, at.data()));
    check(nc_put_var_float(inner, variable, samples.data()));
    check(nc_close(file));
    const auto field = readOrFail(readFile(path));
    EXPECT_EQ(field.shape, (Shape{3, 2, 1, 1}));
    EXPECT_EQ(field.box, (Box{{10, 0, 0, 0}, {30, 1, 0, 0}}));
    EXPECT_TRUE(field.boxIsKnown);
    ASSERT_EQ(field.warnings.size(), 1);
    EXPECT_NE(field.warnings.front().find("run/last/f"), std::string::npos) << field.warnings.front();
    EXPECT_EQ(readOrFail(readFile(path), {.variable = "run/last/f"}).box, field.box);
}

TEST(Netcdf, PackedCoordinatesAreUnpacked) {
    const TemporaryFolder folder;
    const std::string path = (folder / "a.nc").string();
    int file = 0, variable = 0;
    std::array<int, 2> dimensions{}, coordinates{};
    check(nc_create(path.c_str(), NC_CLOBBER, &file));
    const std::array<const char*, 2> names{"y", "x"};
    const std::array<std::size_t, 2> sizes{2, 3};
    const std::array<double, 2> scales{-0.5, 0.25}, offsets{3, -1};
    for (std::size_t i = 0; i < 2; ++i) {
        check(nc_def_dim(file, names[i], sizes[i], &dimensions[i]));
        check(nc_def_var(file, names[i], NC_SHORT, 1, &dimensions[i], &coordinates[i]));
        check(nc_put_att_double(file, coordinates[i], "scale_factor", NC_DOUBLE, 1, &scales[i]));
        check(nc_put_att_double(file, coordinates[i], "add_offset", NC_DOUBLE, 1, &offsets[i]));
    }
    check(nc_def_var(file, "f", NC_FLOAT, 2, dimensions.data(), &variable));
    check(nc_enddef(file));
    const std::array<short, 3> stored{0, 1, 2};
    const std::array<float, 6> samples{0, 1, 2, 3, 4, 5};
    for (const int coordinate : coordinates) check(nc_put_var_short(file, coordinate, stored.data()));
    check(nc_put_var_float(file, variable, samples.data()));
    check(nc_close(file));
    const auto field = readOrFail(readFile(path));
    EXPECT_EQ(field.box, (Box{{-1, 2.5, 0, 0}, {-0.5, 3, 0, 0}}));
    const auto values = field.samples.values();
    EXPECT_EQ(std::vector(values.begin(), values.end()), (std::vector<float>{3, 4, 5, 0, 1, 2}));  // y decreases
}

TEST(Netcdf, HeadersMayBeLongerThanTheValues) {
    const TemporaryFolder folder;
    const std::string path = (folder / "a.nc").string();
    for (const std::size_t length : {0, 20, 100, 300, 3000, 40'000}) {
        SCOPED_TRACE(length);
        int file = 0, dimension = 0, variable = 0;
        check(nc_create(path.c_str(), NC_CLOBBER, &file));
        check(nc_def_dim(file, "x", 3, &dimension));
        check(nc_def_var(file, "f", NC_FLOAT, 1, &dimension, &variable));
        check(nc_put_att_text(file, variable, "comment", length, std::string(length, 'a').c_str()));
        check(nc_enddef(file));
        const std::array<float, 3> samples{1, 2, 4};
        check(nc_put_var_float(file, variable, samples.data()));
        check(nc_close(file));
        EXPECT_EQ(readOrFail(readFile(path)).samples.values()[2], 4);
    }
}

TEST(Netcdf, ValuesNeverWrittenAreMissing) {
    const TemporaryFolder folder;
    const std::string path = (folder / "a.nc").string();
    int file = 0, dimension = 0, variable = 0;
    check(nc_create(path.c_str(), NC_CLOBBER, &file));
    check(nc_def_dim(file, "q", 3, &dimension));
    check(nc_def_var(file, "f", NC_DOUBLE, 1, &dimension, &variable));
    check(nc_enddef(file));
    const std::size_t at = 1;
    const double number = 2;
    check(nc_put_var1_double(file, variable, &at, &number));
    check(nc_close(file));
    const auto field = readOrFail(readFile(path));
    EXPECT_TRUE(std::isnan(field.samples.values()[0]));
    EXPECT_EQ(field.samples.values()[1], 2);
    EXPECT_FALSE(field.boxIsKnown);
}

TEST(Netcdf, LimitsAreRoundedToTheTypeOfTheNumbers) {
    const TemporaryFolder folder;
    const std::string path = (folder / "a.nc").string();
    const double missing[2] = {-999.9, 3.4028235e38}, most = 0.1;
    int file = 0, dimension = 0, variable = 0;
    check(nc_create(path.c_str(), NC_CLOBBER, &file));
    check(nc_def_dim(file, "x", 4, &dimension));
    check(nc_def_var(file, "f", NC_FLOAT, 1, &dimension, &variable));
    check(nc_put_att_double(file, variable, "missing_value", NC_DOUBLE, 2, missing));
    check(nc_put_att_double(file, variable, "valid_max", NC_DOUBLE, 1, &most));
    check(nc_enddef(file));
    const std::array<float, 4> stored{-999.9F, 0.1F, std::numeric_limits<float>::max(), -999.8F};
    check(nc_put_var_float(file, variable, stored.data()));
    check(nc_close(file));
    const auto field = readOrFail(readFile(path));
    const auto values = field.samples.values();
    EXPECT_TRUE(std::isnan(values[0]));
    EXPECT_EQ(values[1], 0.1F);
    EXPECT_TRUE(std::isnan(values[2]));
    EXPECT_EQ(values[3], -999.8F);
}

TEST(Hdf5, FindsDatasetsByTheirPath) {
    const auto samples = numbers();
    const auto bytes = hdf5(samples);
    EXPECT_EQ(readOrFail(bytes, {.variable = "/run/f"}).quantity.name, "f");
    EXPECT_EQ(readOrFail(bytes, {.variable = "run/f", .maxSamples = 120}).shape, kShape);
    for (const std::string path : {"run", "f", "/", "run/f/", "/run/g", "../a"}) {
        const auto field = readHdf5(FileContents::copyOf(bytes), {.variable = path});
        ASSERT_FALSE(field) << path;
        EXPECT_EQ(field.error().code, ErrorCode::not_found);
    }
    EXPECT_EQ(readHdf5(FileContents::copyOf(bytes), {.maxSamples = 119}).error().code, ErrorCode::too_large);
}

// Adds an attribute with this text to the dataset run/f of a file made by hdf5(): of the length of the text, or of
// variable length, as h5py writes it.
std::string withAttribute(const std::string& bytes, const char* name, const std::string& text, bool isVariable) {
    const TemporaryFolder folder;
    const auto path = folder / "a.h5";
    writeFile(path, bytes);
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    const hid_t dataset = H5Dopen2(file, "run/f", H5P_DEFAULT);
    const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
    H5Tset_size(type, isVariable ? H5T_VARIABLE : text.size());
    if (isVariable) H5Tset_cset(type, H5T_CSET_UTF8);
    const hid_t attribute = H5Acreate2(dataset, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    const char* const start = text.c_str();
    const void* const value = isVariable ? static_cast<const void*>(&start) : start;
    EXPECT_GE(H5Awrite(attribute, type, value), 0);
    H5Aclose(attribute);
    H5Sclose(space);
    H5Tclose(type);
    H5Dclose(dataset);
    H5Fclose(file);
    return readFile(path);
}

TEST(Hdf5, ReadsTheUnitAndTheNameOfTheQuantity) {
    const std::string plain = hdf5(numbers());
    EXPECT_EQ(readOrFail(plain).quantity, (Quantity{"f", ""}));
    for (const bool isVariable : {false, true}) {
        const std::string bytes = withAttribute(plain, "units", "m s⁻¹", isVariable);
        EXPECT_EQ(readOrFail(bytes).quantity, (Quantity{"f", "m s⁻¹"})) << isVariable;
        EXPECT_EQ(readOrFail(withAttribute(bytes, "long_name", "speed", !isVariable)).quantity,
                  (Quantity{"speed", "m s⁻¹"}));
        EXPECT_EQ(readOrFail(withAttribute(plain, "units", "K\xff", isVariable)).quantity.unit, "K?");
        const std::string cut =
            readOrFail(withAttribute(plain, "units", std::string(60'000, 'K'), isVariable)).quantity.unit;
        EXPECT_LE(cut.size(), kMaxQuantityText);
        EXPECT_TRUE(cut.starts_with("KKK") && cut.ends_with("…")) << cut;
    }
    EXPECT_EQ(readOrFail(withAttribute(plain, "units", "K   ", false)).quantity.unit, "K") << "padded";
}

TEST(Hdf5, FollowsSoftLinksWithinTheFile) {
    const auto samples = numbers();
    const auto bytes = hdf5(samples, {.softLinks = true});
    const auto expected = bitsOf(readOrFail(bytes));
    for (const std::string path : {"latest", "/latest", "last/f", "twice"})
        EXPECT_EQ(bitsOf(readOrFail(bytes, {.variable = path})), expected) << path;
    for (const std::string path : {"last", "dangling", "circular", "last/latest"}) {
        const auto field = readHdf5(FileContents::copyOf(bytes), {.variable = path});
        ASSERT_FALSE(field) << path;
        EXPECT_EQ(field.error().code, ErrorCode::not_found);
    }
}

TEST(Hdf5, ReadsFloatsOfTwoBytes) {
    const std::vector<std::uint16_t> bits{0x0000, 0x0001, 0x03ff, 0x0400, 0x3c00,
                                          0x3c01, 0xc000, 0x7bff, 0x7c00, 0x7e00};
    const std::vector<float> expected{0, 0x1p-24F, 0x1.ff8p-15F, 0x1p-14F, 1, 1.0009765625F, -2, 65504};
    for (const bool bigEndian : {false, true}) {
        const auto field = readOrFail(hdf5OfHalves(bits, bigEndian));
        const auto values = field.samples.values();
        ASSERT_EQ(values.size(), bits.size());
        for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(values[i], expected[i]) << i;
        for (std::size_t i = expected.size(); i < bits.size(); ++i) EXPECT_FALSE(std::isfinite(values[i])) << i;
    }
}

TEST(Hdf5, UsesFloatsInPlace) {
    const TemporaryFolder folder;
    const auto samples = numbers();
    writeFile(folder / "a.h5", hdf5(samples));
    const auto file = FileContents::map(folder / "a.h5");
    const auto field = readHdf5(*file, {});
    ASSERT_TRUE(field);
    EXPECT_EQ(field->samples.memoryBytes(), 0);
    EXPECT_GT(readHdf5(*file, {.axes = "xyzt"})->samples.memoryBytes(), 0);
}

TEST(Hdf5, RefusesFilesThatReferToOthers) {
    const auto field = readHdf5(FileContents::copyOf(hdf5({}, {.external = true})), {});
    ASSERT_FALSE(field);
    EXPECT_NE(field.error().message.find("other files"), std::string::npos);
    const TemporaryFolder folder;
    const std::string path = (folder / "a.h5").string();
    const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_external("/tmp/other.h5", "/f", file, "f", H5P_DEFAULT, H5P_DEFAULT);
    H5Fclose(file);
    const auto linked = readHdf5(FileContents::copyOf(readFile(path)), {.variable = "f"});
    ASSERT_FALSE(linked);
    EXPECT_NE(linked.error().message.find("other files"), std::string::npos);
}

TEST(Nifti, ReadsTheGeometry) {
    const auto samples = numbers();
    const auto place = [](nifti_image& image) {
        image.pixdim[1] = image.dx = 2;
        image.pixdim[2] = image.dy = 3;
        image.pixdim[3] = image.dz = 4;
        image.pixdim[4] = image.dt = 0.5F;
        image.xyz_units = NIFTI_UNITS_MM;
        image.time_units = NIFTI_UNITS_SEC;
        image.toffset = 1.5F;
    };
    const auto plain = readOrFail(nifti("a.nii", samples, place));
    EXPECT_EQ(plain.box, (Box{{-4, -4.5, -4, 1.5}, {4, 4.5, 4, 2}}));
    EXPECT_EQ(plain.units, (std::array<std::string, 4>{"mm", "mm", "mm", "s"}));
    EXPECT_EQ(readOrFail(nifti("a.nii.gz", samples, place)).box, plain.box);
    EXPECT_EQ(readOrFail(nifti("a.nii", samples, place), {.axes = "xyzw"}).units, (AxisUnits{"s", "mm", "mm", "mm"}))
        << "the fourth dimension, the first index in Python, is x";

    // i goes along −y, j along x, k along z.
    const auto turn = [&](nifti_image& image) {
        place(image);
        image.sform_code = 1;
        image.sto_xyz = {{{0, 3, 0, 100}, {-2, 0, 0, 200}, {0, 0, 4, 300}, {0, 0, 0, 1}}};
    };
    const auto turned = readOrFail(nifti("a.nii", samples, turn));
    EXPECT_EQ(turned.shape, (Shape{4, 5, 3, 2}));
    EXPECT_EQ(turned.box, (Box{{100, 192, 300, 1.5}, {109, 200, 308, 2}}));
    for (std::size_t i = 0; i < 5; ++i) {
        for (std::size_t j = 0; j < 4; ++j)
            EXPECT_EQ(turned.samples.values()[j + 4 * (4 - i) + 20], samples[i + 5 * j + 20]);
    }

    // The same by a quaternion: a rotation of 180° about z, and a reversed k.
    const auto rotate = [&](nifti_image& image) {
        place(image);
        image.qform_code = 1;
        image.quatern_b = image.quatern_c = 0;
        image.quatern_d = 1;
        image.qfac = image.pixdim[0] = -1;
        image.qoffset_x = image.qoffset_y = image.qoffset_z = 10;
    };
    const auto rotated = readOrFail(nifti("a.nii", samples, rotate));
    EXPECT_EQ(rotated.box, (Box{{2, 1, 2, 1.5}, {10, 10, 10, 2}}));
    EXPECT_EQ(rotated.samples.values()[59], samples[0]);

    const auto oblique = [&](nifti_image& image) {
        turn(image);
        image.sto_xyz.m[0][0] = 1;
    };
    EXPECT_EQ(readOrFail(nifti("a.nii", samples, oblique)).warnings.size(), 1);
    EXPECT_EQ(readOrFail(nifti("a.nii", samples, oblique)).box, plain.box);
}

TEST(Nifti, ScalesNumbers) {
    const auto field = readOrFail(nifti("a.nii", numbers(), [](nifti_image& image) {
        auto* const shorts = static_cast<short*>(image.data);
        for (short i = 0; i < static_cast<short>(kCount); ++i) shorts[i] = i;
        image.datatype = DT_INT16;
        image.nbyper = 2;
        image.scl_slope = 0.5F;
        image.scl_inter = -3;
    }));
    for (std::size_t i = 0; i < kCount; ++i) EXPECT_EQ(field.samples.values()[i], 0.5F * static_cast<float>(i) - 3);
}

TEST(Nifti, SurvivesEveryTruncationAndMutation) {
    expectRobust(nifti("a.nii", numbers()), 352, readNifti);
    expectRobust(nifti("a.nii.gz", numbers()), 1000, readNifti);
}

// The libraries may crash on damaged files, which are therefore read in another process. These do not make them crash.
TEST(FieldFormats, SurviveTruncation) {
    for (const auto& file : {netcdf(0, numbers()), netcdf(NC_64BIT_DATA, numbers())})
        expectRobust(file, 0, readNetcdf, 7);
    expectRobust(hdf5(numbers()), 0, readHdf5, 101);
}

TEST(FieldSeries, JoinsFilesAlongW) {
    const TemporaryFolder folder;
    for (const int moment : {10, 2, 1})
        writeFile(folder / ("t" + std::to_string(moment) + ".npy"),
                  npy("(2, 2, 2)", std::vector<float>(8, static_cast<float>(moment))));
    writeFile(folder / "notes.txt", "not a field");
    writeFile(folder / ".t0.npy", npy("(2, 2, 2)", std::vector<float>(8)));
    std::filesystem::create_directory(folder / "more");
    const auto paths = seriesFiles(folder.path());
    ASSERT_TRUE(paths);
    ASSERT_EQ(paths->size(), 3);
    EXPECT_EQ((*paths)[1].filename(), "t2.npy");
    std::vector<FileContents> files;
    for (const auto& path : *paths) files.push_back(*FileContents::map(path));
    const auto series = readSeries(files, {});
    ASSERT_TRUE(series) << series.error().message;
    EXPECT_EQ(series->shape, (Shape{2, 2, 2, 3}));
    EXPECT_EQ(series->samples.values()[7], 1);
    EXPECT_EQ(series->samples.values()[8], 2);
    EXPECT_EQ(series->samples.values()[23], 10);
    EXPECT_EQ(readSeries(files, {.maxSamples = 23}).error().code, ErrorCode::too_large);
    EXPECT_EQ(readSeries({}, {}).error().code, ErrorCode::bad_field);
    files.push_back(FileContents::copyOf(npy("(2, 2, 1)", std::vector<float>(4))));
    EXPECT_NE(readSeries(files, {}).error().message.find("file 4"), std::string::npos);
    EXPECT_EQ(seriesFiles(folder / "none").error().code, ErrorCode::not_found);
}

TEST(FieldSeries, DecompressesLargeFilesIntoFewNewFiles) {
    std::vector<FileContents> files;
    for (int moment = 0; moment < 6; ++moment) {
        files.push_back(FileContents::copyOf(nifti("a.nii.gz", numbers(), [&](nifti_image& image) {
            image.nt = image.dim[4] = 1;
            image.nvox = kCount / 2;
            static_cast<float*>(image.data)[0] = static_cast<float>(moment);
        })));
    }
    const TemporaryFolder folder;
    int made = 0;
    const auto newFile = [&](std::size_t bytes) {
        const auto path = folder / std::to_string(made++);
        writeFile(path, std::string(bytes, '\0'));
        return MappedFile::mapToWrite(std::make_shared<const FileHandle>(open(path.c_str(), O_RDWR | O_CLOEXEC)));
    };
    const auto series = readSeries(files, {.maxInMemory = 1, .newFile = newFile});
    ASSERT_TRUE(series) << series.error().message;
    ASSERT_EQ(series->samples.values().size(), 6 * kCount / 2);
    for (std::size_t moment = 0; moment < 6; ++moment)
        EXPECT_EQ(series->samples.values()[moment * kCount / 2], static_cast<float>(moment));
    EXPECT_LE(made, 4) << "the server makes no more for an array";
}

// A variable f(time, x) of one moment, with this unit. `mode`: see netcdf().
std::string netcdfOfMoment(double time, int mode = 0, const std::string& unit = "K") {
    const TemporaryFolder folder;
    const std::string path = (folder / "a.nc").string();
    int file = 0, coordinate = 0, variable = 0;
    std::array<int, 2> dimensions{};
    check(nc_create(path.c_str(), mode | NC_CLOBBER, &file));
    check(nc_def_dim(file, "time", 1, &dimensions[0]));
    check(nc_def_dim(file, "x", 2, &dimensions[1]));
    check(nc_def_var(file, "time", NC_DOUBLE, 1, dimensions.data(), &coordinate));
    check(nc_def_var(file, "f", NC_FLOAT, 2, dimensions.data(), &variable));
    check(nc_put_att_text(file, coordinate, "units", 1, "s"));
    check(nc_put_att_text(file, variable, "units", unit.size(), unit.data()));
    check(nc_enddef(file));
    const std::array<float, 2> samples{1, 2};
    check(nc_put_var_double(file, coordinate, &time));
    check(nc_put_var_float(file, variable, samples.data()));
    check(nc_close(file));
    return readFile(path);
}

// NetCDF before version 4.4.1 did not write the attribute _NCProperties.
TEST(Hdf5, ReadsDimensionScalesAsNetcdfDoes) {
    const TemporaryFolder folder;
    const auto path = folder / "a.nc";
    writeFile(path, netcdfOfMoment(3, NC_NETCDF4));
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    ASSERT_GE(H5Adelete(file, "_NCProperties"), 0);
    H5Fclose(file);
    const FieldArray field = readOrFail(readFile(path));
    EXPECT_TRUE(field.boxIsKnown);
    EXPECT_EQ(field.shape, (Shape{2, 1, 1, 1}));
    EXPECT_EQ(field.box, (Box{{0, 0, 0, 3}, {1, 0, 0, 3}}));
}

// A series of files with these times.
Result<FieldArray> seriesOf(const std::vector<double>& times) {
    std::vector<FileContents> files;
    for (const double time : times) files.push_back(FileContents::copyOf(netcdfOfMoment(time)));
    return readSeries(files, {});
}

TEST(FieldSeries, WarnsOfUnevenTimes) {
    for (const auto& [times, warnings] :
         {std::pair{std::vector{3.0, 5.0, 7.0}, 0U}, {std::vector{3.0, 4.0, 7.0}, 1U}}) {
        const auto series = seriesOf(times);
        ASSERT_TRUE(series) << series.error().message;
        EXPECT_EQ(series->box.min.w, 3);
        EXPECT_EQ(series->box.max.w, 7);
        EXPECT_EQ(series->warnings.size(), warnings);
    }
    EXPECT_NE(seriesOf({3, 4, 7})->warnings.front().find("not evenly spaced"), std::string::npos);
}

TEST(FieldSeries, KeepsTheUnitsThatAllFilesHave) {
    EXPECT_EQ(seriesOf({3, 5})->units, (AxisUnits{"", "", "", "s"}));
    EXPECT_EQ(seriesOf({3, 5})->quantity, (Quantity{"f", "K"}));
    EXPECT_EQ(seriesOf({5, 3})->units[3], "") << "w is the number of the file";
    std::vector<FileContents> files;
    for (const auto& [time, unit] : {std::pair{3., "K"}, {5., "degC"}, {7., "degC"}})
        files.push_back(FileContents::copyOf(netcdfOfMoment(time, 0, unit)));
    const auto mixed = readSeries(files, {});
    ASSERT_TRUE(mixed) << mixed.error().message;
    EXPECT_EQ(mixed->quantity, (Quantity{"f", ""}));
    ASSERT_EQ(mixed->warnings.size(), 1U);
    EXPECT_EQ(mixed->warnings.front(),
              "file 2 of the series: the unit of its values is 'degC', but that of the first file is 'K'");
}

TEST(Netcdf, LongAndDamagedUnitsAreCut) {
    EXPECT_EQ(readOrFail(netcdfOfMoment(3, 0, "\xff\xfe K")).quantity.unit, "?? K");
    const std::string cut = readOrFail(netcdfOfMoment(3, 0, std::string(100'000, 'm'))).quantity.unit;
    EXPECT_LE(cut.size(), kMaxQuantityText);
    EXPECT_TRUE(cut.ends_with("…")) << cut;
}

TEST(FieldSeries, WarnsOfTimesThatDoNotIncrease) {
    for (const auto& [times, warnings] : {std::pair{std::vector{7.0, 5.0, 3.0}, 1U},
                                          {std::vector{3.0, 3.0, 5.0}, 1U},
                                          {std::vector{3.0, 3.0, 3.0}, 0U}}) {
        const auto series = seriesOf(times);
        ASSERT_TRUE(series) << series.error().message;
        EXPECT_EQ(series->box.min.w, 0);
        EXPECT_EQ(series->box.max.w, 2);
        EXPECT_EQ(series->warnings.size(), warnings);
    }
    EXPECT_NE(seriesOf({7, 5, 3})->warnings.front().find("do not increase"), std::string::npos);
}

}  // namespace
}  // namespace oval4d::fields::test
