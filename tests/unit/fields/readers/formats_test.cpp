// Tests that read the same array from files of all formats, which the formats' own libraries have written.

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "fields/readers/field_reader.hpp"
#include "fields/readers/hdf5.hpp"
#include "fields/readers/netcdf.hpp"
#include "unit/fields/readers/written_formats.hpp"

namespace oval4d::fields::test {
namespace {

TEST(FieldFormats, GiveTheSameBits) {
    const auto samples = numbers();
    const auto expected = sampleBits(readOrFail(npyOf(samples)));
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
        const FieldFileFormat* const format = formatOfFile(file.bytes);
        ASSERT_NE(format, nullptr);
        EXPECT_EQ(format->name, name);
        const auto field = readOrFail(bytes);
        EXPECT_EQ(field.shape, kShape) << name;
        EXPECT_EQ(sampleBits(field), expected) << name;
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

// Truncated files do not crash the libraries. Other damage may crash them, so the server reads files in another
// process.
TEST(FieldFormats, SurviveTruncation) {
    for (const auto& file : {netcdf(0, numbers()), netcdf(NC_64BIT_DATA, numbers())})
        expectRobust(file, 0, readNetcdf, 7);
    expectRobust(hdf5(numbers()), 0, readHdf5, 101);
}

}  // namespace
}  // namespace oval4d::fields::test
