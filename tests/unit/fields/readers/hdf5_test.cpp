// Tests of the reader of HDF5 files; the HDF5 library writes the files.

#include "fields/readers/hdf5.hpp"

#include <gtest/gtest.h>
#include <hdf5.h>
#include <netcdf.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "unit/fields/readers/written_formats.hpp"

namespace oval4d::fields::test {
namespace {

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

// Adds an attribute with the text `text` to the dataset run/f of a file made by hdf5(). The type of the attribute has
// the length of the text, or a variable length, as h5py writes it.
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
    const auto expected = sampleBits(readOrFail(bytes));
    for (const std::string path : {"latest", "/latest", "last/f", "twice"})
        EXPECT_EQ(sampleBits(readOrFail(bytes, {.variable = path})), expected) << path;
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

// Writes the numbers of numbers() as a dataset with these sizes, in chunks of at most two numbers along a dimension, or
// in one piece.
std::string hdf5OfSizes(const std::vector<hsize_t>& sizes, bool isChunked) {
    const TemporaryFolder folder;
    const std::string path = (folder / "a.h5").string();
    const std::vector<float> samples = numbers();
    const int rank = static_cast<int>(sizes.size());
    std::vector<hsize_t> chunk;
    for (const hsize_t size : sizes) chunk.push_back(std::min<hsize_t>(size, 2));
    const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t space = H5Screate_simple(rank, sizes.data(), nullptr), list = H5Pcreate(H5P_DATASET_CREATE);
    if (isChunked) H5Pset_chunk(list, rank, chunk.data());
    const hid_t dataset = H5Dcreate2(file, "f", H5T_IEEE_F32LE, space, H5P_DEFAULT, list, H5P_DEFAULT);
    H5Dwrite(dataset, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, samples.data());
    H5Dclose(dataset);
    H5Pclose(list);
    H5Sclose(space);
    H5Fclose(file);
    return readFile(path);
}

TEST(Hdf5, LeavesOutDimensionsOfSizeOneIfThereAreMoreThanFour) {
    const std::vector<hsize_t> four{kShape[3], kShape[2], kShape[1], kShape[0]};
    const FieldArray expected = readOrFail(hdf5OfSizes(four, false));
    for (const std::size_t at : {0U, 2U, 4U}) {
        for (const bool isChunked : {false, true}) {
            std::vector<hsize_t> five = four;
            five.insert(five.begin() + static_cast<std::ptrdiff_t>(at), 1);
            const FieldArray field = readOrFail(hdf5OfSizes(five, isChunked));
            EXPECT_EQ(field.shape, expected.shape) << at;
            EXPECT_EQ(sampleBits(field), sampleBits(expected)) << at;
        }
    }
    const auto field = readHdf5(FileContents::copyOf(hdf5OfSizes({2, 2, 5, 3, 2}, false)), {});
    ASSERT_FALSE(field);
    EXPECT_NE(field.error().message.find("1 to 4 dimensions"), std::string::npos) << field.error().message;
}

// NetCDF-4 files without the attribute _NCProperties are recognized. NetCDF before version 4.4.1 wrote such files.
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

}  // namespace
}  // namespace oval4d::fields::test
