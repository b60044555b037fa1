// Tests of series of files with one time step each.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <nifti1_io.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fields/readers/field_reader.hpp"
#include "unit/fields/readers/written_formats.hpp"

namespace oval4d::fields::test {
namespace {

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
        return MappedFile::mapForWriting(std::make_shared<const FileHandle>(open(path.c_str(), O_RDWR | O_CLOEXEC)));
    };
    const auto series = readSeries(files, {.maxInMemory = 1, .newFile = newFile});
    ASSERT_TRUE(series) << series.error().message;
    ASSERT_EQ(series->samples.values().size(), 6 * kCount / 2);
    for (std::size_t moment = 0; moment < 6; ++moment)
        EXPECT_EQ(series->samples.values()[moment * kCount / 2], static_cast<float>(moment));
    EXPECT_LE(made, 4) << "the server makes no more for an array";
}

// Reads a series of files with these times.
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

TEST(FieldSeries, CountsTimesFarFromZeroFromTheFirst) {
    const auto series = seriesOf({1.7e9, 1.7e9 + 60, 1.7e9 + 120});  // for example, seconds since 1970
    ASSERT_TRUE(series) << series.error().message;
    EXPECT_EQ(series->box.min.w, 0);
    EXPECT_EQ(series->box.max.w, 120);
    EXPECT_EQ(series->units[3], "s");
    ASSERT_EQ(series->warnings.size(), 1U);
    EXPECT_NE(series->warnings.front().find("1700000000 s"), std::string::npos) << series->warnings.front();
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
