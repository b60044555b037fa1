#include "fields/readers/npy.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <stdexcept>

#include "unit/fields/readers/files.hpp"

namespace oval4d::fields::test {
namespace {

std::vector<float> samplesOf(const Result<FieldArray>& field) {
    const auto values = field->samples.values();
    return {values.begin(), values.end()};
}

FieldArray readNpyOrFail(const std::string& file, const FieldReadOptions& options = {}) {
    auto field = readNpy(FileContents::copyOf(file), options);
    if (!field) throw std::runtime_error(field.error().message);
    return *field;
}

void expectError(const std::string& file, ErrorCode code, const std::string& text,
                 const FieldReadOptions& options = {}) {
    const auto field = readNpy(FileContents::copyOf(file), options);
    ASSERT_FALSE(field);
    EXPECT_EQ(field.error().code, code);
    EXPECT_NE(field.error().message.find(text), std::string::npos) << field.error().message;
}

std::string reversed(std::string bytes) {
    std::reverse(bytes.begin(), bytes.end());
    return bytes;
}

struct TypeCase {
    std::string type;
    std::function<std::string(double)> bytes;
    std::vector<double> numbers;  // 32-bit floats represent these numbers exactly
};

std::string half(double number) {  // only for the numbers in this function
    if (number == 0.5) return bytesOf(std::uint16_t{0x3800});
    if (number == -2) return bytesOf(std::uint16_t{0xC000});
    if (number == 65504) return bytesOf(std::uint16_t{0x7BFF});  // the largest half-precision number
    return number == 0x1p-24 ? bytesOf(std::uint16_t{1})
                             : bytesOf(std::uint16_t{0x0400});  // the smallest subnormal and the smallest normal number
}

template <typename Number>
std::string store(double number) {
    return bytesOf(static_cast<Number>(number));
}

const std::vector<TypeCase> kTypes{
    {"b1", store<std::uint8_t>, {0, 1, 1, 0}},
    {"i1", store<std::int8_t>, {-128, 127, -1, 5}},
    {"u1", store<std::uint8_t>, {0, 255, 128, 7}},
    {"i2", store<std::int16_t>, {-32768, 32767, 258, -2}},
    {"u2", store<std::uint16_t>, {65535, 0, 258, 32768}},
    {"i4", store<std::int32_t>, {-2147483648., 16777216, 65538, -7}},
    {"u4", store<std::uint32_t>, {4294967040., 0, 65538, 2147483648.}},
    {"i8", store<std::int64_t>, {-0x1p63, 0x1p62, 4294967296., -1}},
    {"u8", store<std::uint64_t>, {0x1p63, 0, 4294967296., 3}},
    {"f2", half, {0.5, -2, 65504, 0x1p-24, 0x1p-14}},
    {"f4", store<float>, {0.1F, -1e30F, 0x1p-140, 5}},
    {"f8", store<double>, {0.5, -0x1p100, 0x1p-140, 5}},
};

TEST(Npy, ReadsEveryTypeInBothByteOrders) {
    for (const TypeCase& each : kTypes) {
        for (const char order : std::string("<>|=")) {
            std::string data;
            for (const double number : each.numbers)
                data += order == '>' ? reversed(each.bytes(number)) : each.bytes(number);
            const auto field =
                readNpyOrFail(npy(order + each.type, false, "(" + std::to_string(each.numbers.size()) + ",)", data));
            EXPECT_EQ(field.shape, (Shape{each.numbers.size(), 1, 1, 1}));
            const auto values = field.samples.values();
            for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(values[i], each.numbers[i]) << each.type << order;
        }
    }
}

TEST(Npy, RoundsToTheNearestFloat) {
    std::string data;
    for (const double number : {0.1, 1e300, -1e39, std::nan("")}) data += bytesOf(number);
    const auto field = readNpyOrFail(npy("<f8", false, "(4,)", data));
    EXPECT_EQ(field.samples.values()[0], 0.1F);
    for (const std::size_t i : {1, 2, 3}) EXPECT_TRUE(std::isnan(field.samples.values()[i]));
    const auto halves = readNpyOrFail(npy("<f2", false, "(3,)", std::string("\x00\x7c\x00\xfc\x01\x7c", 6)));
    EXPECT_TRUE(std::isinf(halves.samples.values()[0]));
    EXPECT_TRUE(std::isinf(halves.samples.values()[1]));
    EXPECT_TRUE(std::isnan(halves.samples.values()[2]));
}

// Dimensions become the axes that the option names. The number at the indices i, j, k, l of the array is 1000 i + 100 j
// + 10 k + l.
TEST(Npy, AssignsDimensionsToAxes) {
    const std::array<std::size_t, 4> shape{2, 3, 4, 5};
    std::string c, f;
    for (std::size_t i = 0; i < 120; ++i) {
        const auto number = [](std::size_t a, std::size_t b, std::size_t e, std::size_t d) {
            return bytesOf(static_cast<float>(1000 * a + 100 * b + 10 * e + d));
        };
        c += number(i / 60, i / 20 % 3, i / 5 % 4, i % 5);
        f += number(i % 2, i / 2 % 3, i / 6 % 4, i / 24);
    }
    const std::string names = "xyzw";
    for (const std::string axes : {"tzyx", "wzyx", "xyzt", "zxwy", "ytxz", ""}) {
        for (const bool fortran : {false, true}) {
            const auto field = readNpyOrFail(npy("<f4", fortran, "(2, 3, 4, 5)", fortran ? f : c), {.axes = axes});
            std::array<std::size_t, 4> axisOf{3, 2, 1, 0};  // the axis of each dimension
            for (std::size_t d = 0; d < axes.size(); ++d) axisOf[d] = axes[d] == 't' ? 3 : names.find(axes[d]);
            for (std::size_t d = 0; d < 4; ++d) ASSERT_EQ(field.shape[axisOf[d]], shape[d]) << axes;
            const auto values = field.samples.values();
            for (std::size_t i = 0; i < 120; ++i) {
                std::array<std::size_t, 4> at{};  // the indices along x, y, z, w
                std::size_t rest = i;
                for (std::size_t axis = 0; axis < 4; ++axis) {
                    at[axis] = rest % field.shape[axis];
                    rest /= field.shape[axis];
                }
                EXPECT_EQ(values[i], 1000 * at[axisOf[0]] + 100 * at[axisOf[1]] + 10 * at[axisOf[2]] + at[axisOf[3]])
                    << axes;
            }
        }
    }
}

TEST(Npy, GivesMissingAxesOneSample) {
    const std::vector<float> numbers{1, 2, 3, 4, 5, 6};
    EXPECT_EQ(readNpyOrFail(npy("(6,)", numbers)).shape, (Shape{6, 1, 1, 1}));
    EXPECT_EQ(readNpyOrFail(npy("(2, 3)", numbers)).shape, (Shape{3, 2, 1, 1}));
    EXPECT_EQ(readNpyOrFail(npy("(1, 2, 3)", numbers)).shape, (Shape{3, 2, 1, 1}));
    EXPECT_EQ(readNpyOrFail(npy("(3, 1, 2)", numbers), {.axes = "wyx"}).shape, (Shape{2, 1, 1, 3}));
}

TEST(Npy, LeavesOutDimensionsOfSizeOneIfThereAreMoreThanFour) {
    std::vector<float> numbers(120);
    std::iota(numbers.begin(), numbers.end(), 0.F);
    const FieldArray expected = readNpyOrFail(npy("(2, 3, 4, 5)", numbers));
    for (const std::string shape : {"(1, 2, 3, 4, 5)", "(2, 3, 1, 4, 5)", "(1, 2, 1, 3, 4, 1, 5)", "(2, 3, 4, 5, 1)"}) {
        const FieldArray field = readNpyOrFail(npy(shape, numbers));
        EXPECT_EQ(field.shape, expected.shape) << shape;
        EXPECT_TRUE(std::ranges::equal(field.samples.values(), expected.samples.values())) << shape;
    }
    EXPECT_EQ(readNpyOrFail(npy("(1, 1, 1, 1, 120)", numbers)).shape, (Shape{120, 1, 1, 1}));
    EXPECT_EQ(readNpyOrFail(npy("(1, 2, 3, 4, 5)", numbers), {.axes = "xyzt"}).shape, (Shape{2, 3, 4, 5}));
    expectError(npy("(2, 3, 2, 2, 5)", numbers), ErrorCode::bad_field, "has 5 dimensions; 1 to 4 are allowed");
}

TEST(Npy, ReadsAllVersionsAndNotations) {
    const std::string data = bytesOf(1.F) + bytesOf(2.F);
    for (const int version : {1, 2, 3})
        EXPECT_EQ(samplesOf(readNpyOrFail(npy("<f4", false, "(2,)", data, version))), (std::vector<float>{1, 2}));
    const auto withHeader = [&](const std::string& header) {
        return std::string("\x93NUMPY\x01\x00", 8) + bytesOf(static_cast<std::uint16_t>(header.size())) + header + data;
    };
    for (const std::string header : {"{'descr':'<f4','fortran_order':False,'shape':(2,)}",
                                     "{\"shape\": (2L,), \"descr\": \"<f4\", 'fortran_order': False}\n",
                                     " { 'shape' : ( 2 , 1 ) , 'fortran_order' : True , 'descr' : '<f4' , } "})
        EXPECT_EQ(samplesOf(readNpyOrFail(withHeader(header))), (std::vector<float>{1, 2})) << header;
    for (const std::string header : {"", "{}", "{'descr': '<f4', 'fortran_order': False}",
                                     "{'descr': '<f4', 'fortran_order': False, 'shape': (2)}",
                                     "{'descr': '<f4', 'fortran_order': False, 'shape': (2,), 'shape': (2,)}",
                                     "{'descr': '<f4', 'fortran_order': 0, 'shape': (2,)}",
                                     "{'descr': '<f4', 'fortran_order': False, 'shape': [2]}",
                                     "{'descr': '<f4', 'fortran_order': False, 'shape': (2,)} x",
                                     "{'descr': '<f4', 'fortran_order': False, 'shape': (-2,)}",
                                     "{'descr': [('a', '<f4')], 'fortran_order': False, 'shape': (2,)}",
                                     "{'descr': '<f4', 'fortran_order': False, 'shape': (2,), 'more': 1}",
                                     "{'descr': '<f4' 'fortran_order': False 'shape': (2,)}",
                                     "{'descr': '<f4', 'fortran_order': False, 'shape': (99999999999999999999999,)}"})
        expectError(withHeader(header), ErrorCode::bad_field, "header");
}

TEST(Npy, RefusesWhatIsNotAFieldOfRealNumbers) {
    const std::string data(64, '\0');
    for (const std::string type : {"<c8", "<U1", "|O8", "<f3", "<M8", "f4", "<f16", "<b2", "", "<f", "?<f4"})
        expectError(npy(type, false, "(2,)", data), ErrorCode::bad_field, "type");
    expectError(npy("<f4", false, "()", data), ErrorCode::bad_field, "0 dimensions");
    expectError(npy("<f4", false, "(1, 2, 2, 2, 2, 2)", data), ErrorCode::bad_field, "5 dimensions");
    expectError(npy("<f4", false, "(2, 0)", data), ErrorCode::bad_field, "empty");
    expectError(npy("<f4", false, "(17,)", data), ErrorCode::bad_field, "68 bytes");
    expectError("OFF", ErrorCode::bad_field, "npy");
    expectError(npy("<f4", false, "(2, 2)", data), ErrorCode::too_large, "too many", {.maxSamples = 3});
    expectError(npy("<f4", false, "(16777217,)", data), ErrorCode::too_large, "too many");
    // Products of sizes that overflow are noticed: the first product is 0 modulo 2^64.
    expectError(npy("<f8", false, "(16777216, 16777216, 16777216)", data), ErrorCode::too_large, "too many");
    expectError(npy("<f8", false, "(1048576, 1048576)", data), ErrorCode::bad_field, "8796093022208 bytes");
    for (const std::string axes : {"x", "xyz", "xx", "ta", "wt"})
        expectError(npy("<f4", false, "(2, 2)", data), ErrorCode::out_of_range, "axes", {.axes = axes});
}

TEST(Npy, SurvivesEveryTruncationAndMutation) {
    std::vector<float> numbers(24, 1.5F);
    for (const int version : {1, 2})
        expectRobust(npy("<i2", false, "(2, 3, 4)", std::string(48, 'a'), version), 200, readNpy);
    expectRobust(npy("(2, 3, 4)", numbers), 200, readNpy);
}

TEST(Npy, WarnsOfBytesAfterTheArray) {
    EXPECT_TRUE(readNpyOrFail(npy("(2,)", {1, 2})).warnings.empty());
    EXPECT_EQ(readNpyOrFail(npy("(2,)", {1, 2, 3})).warnings.size(), 1);
}

TEST(Npy, UsesFloatsInPlace) {
    const TemporaryFolder folder;
    writeFile(folder / "a.npy", npy("(2, 3)", {1, 2, 3, 4, 5, 6}));
    const auto file = FileContents::map(folder / "a.npy");
    ASSERT_TRUE(file);
    const auto inPlace = readNpy(*file, {});
    EXPECT_EQ(static_cast<const void*>(inPlace->samples.values().data()), file->bytes.data() + 128);
    EXPECT_EQ(inPlace->samples.memoryBytes(), 0);
    const auto transposed = readNpy(*file, {.axes = "xy"});
    EXPECT_EQ(samplesOf(transposed), (std::vector<float>{1, 4, 2, 5, 3, 6}));
    EXPECT_EQ(transposed->samples.memoryBytes(), 24);
    std::filesystem::remove(folder / "a.npy");  // the file stays mapped after its name is removed
    EXPECT_EQ(samplesOf(inPlace), (std::vector<float>{1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(FileContents::map(folder / "a.npy").error().code, ErrorCode::not_found);
    EXPECT_EQ(FileContents::map(folder.path()).error().code, ErrorCode::bad_field);
}

// Arrays that NumPy writes in each type, byte order and order of indices give the same samples as 32-bit floats in C
// order.
TEST(Npy, ReadsWhatNumpyWrites) {
    if (std::system("/usr/bin/python3 -c 'import numpy' 2>/dev/null") != 0)
        GTEST_SKIP() << "python3-numpy is not installed";
    const TemporaryFolder folder;
    writeFile(folder / "write.py", R"(
import itertools, sys
import numpy as np
rng = np.random.default_rng(1)
types = ["b1", "i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", "f2", "f4", "f8"]
for n, (kind, order, fortran) in enumerate(itertools.product(types, "<>", (False, True))):
    a = (rng.standard_normal((3, 4, 5, 6)) * 100).astype(order + kind)
    a = np.asfortranarray(a) if fortran else np.ascontiguousarray(a)
    np.lib.format.write_array(open(f"{sys.argv[1]}/{n}.npy", "wb"), a, (1 + n % 3, 0))
    np.save(f"{sys.argv[1]}/{n}.float.npy", np.ascontiguousarray(a.astype("<f4")))
)");
    const std::string command = "/usr/bin/python3 " + (folder / "write.py").string() + " " + folder.path().string();
    ASSERT_EQ(std::system(command.c_str()), 0);
    for (int number = 0; number < 48; ++number) {
        const std::string name = std::to_string(number);
        const auto field = readNpyOrFail(readFile(folder / (name + ".npy")));
        const auto expected = readNpyOrFail(readFile(folder / (name + ".float.npy")));
        EXPECT_EQ(field.shape, (Shape{6, 5, 4, 3}));
        EXPECT_EQ(samplesOf(field), samplesOf(expected)) << number;
    }
}

TEST(Npy, ReadsLittleOfAFileLargerThanTheMemory) {
    const TemporaryFolder folder;
    const std::string header = npy("<f4", false, "(100, 400, 400, 250)", "");  // 4 · 10⁹ numbers, 16 GB
    const std::size_t count = 4'000'000'000;
    writeFile(folder / "large.npy", header);
    std::error_code fault;
    std::filesystem::resize_file(folder / "large.npy", header.size() + 4 * count,
                                 fault);  // a hole in the file, which reads as zeros
    if (fault) GTEST_SKIP() << "the file system has no files of 16 GB: " << fault.message();
    {
        std::fstream out(folder / "large.npy", std::ios::binary | std::ios::in | std::ios::out);
        out.seekp(static_cast<std::streamoff>(header.size() + 4 * (count - 1)));
        out << bytesOf(7.F);
    }
    const auto file = FileContents::map(folder / "large.npy");
    ASSERT_TRUE(file) << file.error().message;
    const auto field = readNpy(*file, {.box = Box{glm::dvec4(0), {249, 399, 399, 99}}});
    ASSERT_TRUE(field) << field.error().message;
    const auto array = field->function();
    ASSERT_TRUE(array);
    const ArrayFunction& f = **array;
    EXPECT_FALSE(f.statisticsAreExact());
    std::vector<float> x{249, 248.5, 10}, y{399, 399, 20}, z{399, 399, 30}, w{99, 99, 40}, values(3);
    f.evaluate({x, y, z, w}, values);
    EXPECT_EQ(values, (std::vector<float>{7, 3.5, 0}));
    const ValueBounds corner = f.boundsIn({{245, 395, 395, 95}, {249, 399, 399, 99}});
    EXPECT_GE(corner.max, 7);
    EXPECT_TRUE(corner.hasValueEverywhere);
    EXPECT_FALSE(f.boundsIn(f.box()).hasValueEverywhere);
    EXPECT_LT(f.memoryBytes(), 50'000'000) << "bounds and a selection, of 16 GB";
}

}  // namespace
}  // namespace oval4d::fields::test
