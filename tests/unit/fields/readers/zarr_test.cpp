#include "fields/readers/zarr.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "unit/fields/readers/files.hpp"
#include "unit/fields/readers/zarr_files.hpp"

namespace oval4d::fields::test {
namespace {

// Returns the .zarray file of an array of 32-bit floats. `shape` and `chunk` are JSON lists of sizes.
std::string zarray(const std::string& shape, const std::string& chunk, const std::string& fill = "0") {
    return R"({"zarr_format":2,"dtype":"<f4","order":"C","filters":null,"compressor":null,"shape":)" + shape +
           R"(,"chunks":)" + chunk + R"(,"fill_value":)" + fill + "}";
}

TEST(Zarr, EmptyArraysWithCoordinatesAreNamed) {
    const auto field = readFiles({{"f/.zarray", zarray("[0,2,2]", "[1,2,2]")},
                                  {"f/.zattrs", R"({"_ARRAY_DIMENSIONS":["time","y","x"]})"},
                                  {"time/.zarray", zarray("[0]", "[1]")}},
                                 "f");
    ASSERT_FALSE(field);
    EXPECT_EQ(field.error().code, ErrorCode::bad_field);
    EXPECT_EQ(field.error().message, "the array is empty");
}

TEST(Zarr, LimitsAreRoundedToTheTypeOfTheNumbers) {
    const auto field =
        readFiles({{".zarray", zarray("[6]", "[4]", "1e20")},
                   {".zattrs", R"({"_ARRAY_DIMENSIONS":["x"],"missing_value":[-999.9,3.4028235e38],"valid_max":1e30})"},
                   {"0", chunkOf({1e20F, 2, -999.9F, 1e30F})}});
    ASSERT_TRUE(field) << field.error().message;
    const auto values = field->samples.values();
    EXPECT_TRUE(std::isnan(values[0]));
    EXPECT_EQ(values[1], 2);
    EXPECT_TRUE(std::isnan(values[2]));
    EXPECT_EQ(values[3], 1e30F);
    EXPECT_TRUE(std::isnan(values[4])) << "in a missing chunk";
}

TEST(Zarr, AMissingVariableIsNotFound) {
    const Files group{{".zgroup", R"({"zarr_format":2})"}, {"f/.zarray", zarray("[2]", "[2]")}};
    ASSERT_TRUE(readFiles(group, "f"));
    const auto field = readFiles(group, "g");
    ASSERT_FALSE(field);
    EXPECT_EQ(field.error().code, ErrorCode::not_found);
}

TEST(Zarr, ReadsTheUnitsOfTheValuesAndOfTheCoordinates) {
    const auto filesWith = [](const std::string& coordinates) {
        return Files{{".zgroup", R"({"zarr_format":2})"},
                     {"f/.zarray", zarray("[2]", "[2]")},
                     {"f/.zattrs", R"({"_ARRAY_DIMENSIONS":["x"],"long_name":"speed","units":"m s-1"})"},
                     {"f/0", chunkOf({1, 2})},
                     {"x/.zarray", zarray("[2]", "[2]")},
                     {"x/.zattrs", R"({"_ARRAY_DIMENSIONS":["x"],"units":"km"})"},
                     {"x/0", coordinates}};
    };
    const auto field = readFiles(filesWith(chunkOf({0, 5})), "f");
    ASSERT_TRUE(field) << field.error().message;
    EXPECT_EQ(field->quantity, (Quantity{"speed", "m s-1"}));
    EXPECT_EQ(field->units, (AxisUnits{"km", "", "", ""}));
    const auto constant = readFiles(filesWith(chunkOf({5, 5})), "f");
    ASSERT_TRUE(constant) << constant.error().message;
    EXPECT_EQ(constant->units[0], "") << "the box counts samples, because the coordinates do not increase";
}

TEST(Zarr, EscapedQuotesDoNotEndStrings) {
    const std::string name = R"("long_name":"a 6\" \\\"layer\" \\")";
    std::string metadata = zarray("[4]", "[2]", R"("NaN")");
    metadata.insert(1, R"("comment":"5\" pipe",)");
    const auto field = readFiles(
        {{".zarray", metadata}, {".zattrs", "{" + name + R"(,"missing_value":NaN})"}, {"0", chunkOf({1, 2})}});
    ASSERT_TRUE(field) << field.error().message;
    EXPECT_EQ(field->quantity.name, R"(a 6" \"layer" \)");
    EXPECT_EQ(field->samples.values()[1], 2);
    EXPECT_TRUE(std::isnan(field->samples.values()[2]));
}

TEST(Zarr, TransformationsOfTheImageFollowThoseOfTheLevel) {
    const std::string image = R"({"multiscales":[{"axes":[{"name":"y"},{"name":"x","unit":"micrometer"}],
        "datasets":[{"path":"0","coordinateTransformations":[
            {"type":"scale","scale":[2,3]},{"type":"translation","translation":[1,5]}]}],
        "coordinateTransformations":[
            {"type":"scale","scale":[10,0.5]},{"type":"translation","translation":[4,0.25]}]}]})";
    const auto field =
        readFiles({{".zgroup", R"({"zarr_format":2})"}, {".zattrs", image}, {"0/.zarray", zarray("[2,3]", "[2,3]")}});
    ASSERT_TRUE(field) << field.error().message;
    EXPECT_EQ(field->box, (Box{{2.75, 14, 0, 0}, {5.75, 34, 0, 0}}));
    EXPECT_EQ(field->units, (AxisUnits{"micrometer", "", "", ""}));
    EXPECT_FALSE(field->quantity.isKnown()) << "the array is called 0";
}

TEST(Zarr, ReadsTheFillValueOfXarrayInBase64) {
    const auto file = [](const std::string& type, const std::string& fill) {
        return R"({"zarr_format":3,"node_type":"array","shape":[3],"fill_value":0,"data_type":")" + type +
               R"(","chunk_grid":{"name":"regular","configuration":{"chunk_shape":[3]}},
                  "chunk_key_encoding":{"name":"default"},
                  "codecs":[{"name":"bytes","configuration":{"endian":"little"}}],
                  "attributes":{"_FillValue":")" +
               fill + "\"}}";
    };
    const auto samples = [&](const std::string& type, const std::string& fill) {
        const std::string chunk = type == "int32" ? bytesOf(std::array{1, -9999, 3}) : chunkOf({1, -9999, 3});
        const auto field = readFiles({{"zarr.json", file(type, fill)}, {"c/0", chunk}});
        EXPECT_TRUE(field) << field.error().message;
        const auto values = field->samples.values();
        return std::vector(values.begin(), values.end());
    };
    EXPECT_TRUE(std::isnan(samples("float32", "AAAAAICHw8A=")[1]));
    EXPECT_EQ(samples("float32", "AAAAAICHw8A=")[2], 3);
    // These fill values are ignored: NaN; too few and too many bytes; no padding; not Base64.
    for (const std::string fill : {"AAAAAAAA+H8=", "AAAAAICHww==", "AAAAAICHw8AA", "AAAAAICHw8A", "-Infinity", "?", ""})
        EXPECT_EQ(samples("float32", fill)[1], -9999) << fill;
    EXPECT_EQ(samples("int32", "AAAAAICHw8A=")[1], -9999);
}

// Returns the sample at these indices along x, y, z, w in the arrays of the following tests.
float expectedSample(std::size_t x, std::size_t y, std::size_t z, std::size_t w) {
    return static_cast<float>(1 + x + 10 * y + 100 * z + 1000 * w);
}

// Returns the files of an array of 5 × 4 × 7 × 6 numbers with the axes t z y x. Its chunks of 2 × 3 × 4 × 6 numbers
// extend beyond the array.
Files filesInChunks() {
    constexpr std::array<std::size_t, 4> kShape{6, 7, 4, 5}, kChunk{6, 4, 3, 2};  // along x, y, z, t
    Files files{{".zarray", zarray("[5,4,7,6]", "[2,3,4,6]")}};
    for (std::size_t t = 0; t < kShape[3]; t += kChunk[3]) {
        for (std::size_t z = 0; z < kShape[2]; z += kChunk[2]) {
            for (std::size_t y = 0; y < kShape[1]; y += kChunk[1]) {
                std::vector<float> numbers;
                for (std::size_t l = 0; l < kChunk[3]; ++l)
                    for (std::size_t k = 0; k < kChunk[2]; ++k)
                        for (std::size_t j = 0; j < kChunk[1]; ++j)
                            for (std::size_t i = 0; i < kChunk[0]; ++i)
                                numbers.push_back(expectedSample(i, y + j, z + k, t + l));
                const std::string name = std::to_string(t / kChunk[3]) + '.' + std::to_string(z / kChunk[2]) + '.' +
                                         std::to_string(y / kChunk[1]) + ".0";
                files[name] = chunkOf(numbers);
            }
        }
    }
    return files;
}

TEST(Zarr, ReadsARegionFromItsOwnChunks) {
    const Files files = filesInChunks();
    const FieldReadOptions whole{.box = Box{{0, 0, 0, 0}, {5, 6, 3, 4}}};  // in this box, the coordinates of a sample
                                                                           // are its indices
    struct Case {
        Box region, expected;  // expected: the box of the samples that cover the region
        std::vector<std::string> chunks;
    };
    for (const auto& [region, expected, chunks] :
         std::vector<Case>{{{{1.5, 4.5, 0, 2}, {3, 5.5, 1, 3}}, {{1, 4, 0, 2}, {3, 6, 1, 3}}, {"1.0.1.0"}},
                           {{{0, 3.5, 2.5, 4}, {0.5, 3.6, 9, 4}},
                            {{0, 3, 2, 4}, {1, 4, 3, 4}},
                            {"2.0.0.0", "2.0.1.0", "2.1.0.0", "2.1.1.0"}},
                           {{{4, 0, 3, 1.4}, {4, 0.1, 3, 1.4}}, {{4, 0, 3, 1}, {4, 1, 3, 1}}, {"0.1.0.0"}}}) {
        FieldReadOptions options = whole;
        options.region = region;
        std::set<std::string> opened;
        const auto field = readFiles(files, options, &opened);
        ASSERT_TRUE(field) << field.error().message;
        EXPECT_EQ(field->box, expected);
        EXPECT_TRUE(field->isPart);
        std::array<std::size_t, 4> first{}, last{};
        for (std::size_t axis = 0; axis < 4; ++axis) {
            first[axis] = static_cast<std::size_t>(expected.min[static_cast<glm::length_t>(axis)]);
            last[axis] = static_cast<std::size_t>(expected.max[static_cast<glm::length_t>(axis)]);
            EXPECT_EQ(field->shape[axis], last[axis] - first[axis] + 1) << axis;
        }
        std::vector<float> values;
        for (std::size_t w = first[3]; w <= last[3]; ++w)
            for (std::size_t z = first[2]; z <= last[2]; ++z)
                for (std::size_t y = first[1]; y <= last[1]; ++y)
                    for (std::size_t x = first[0]; x <= last[0]; ++x) values.push_back(expectedSample(x, y, z, w));
        const auto samples = field->samples.values();
        EXPECT_EQ(std::vector(samples.begin(), samples.end()), values);
        std::erase_if(opened, [](const std::string& path) { return path.starts_with(".z") || path == "zarr.json"; });
        EXPECT_EQ(opened, std::set<std::string>(chunks.begin(), chunks.end()));
    }
    FieldReadOptions all = whole;
    all.region = Box{{-1, -1, -1, -1}, {9, 9, 9, 9}};
    const auto one = readFiles(files, all), other = readFiles(files, whole);
    ASSERT_TRUE(one && other);
    EXPECT_FALSE(one->isPart);
    EXPECT_EQ(one->box, other->box);
    EXPECT_TRUE(std::ranges::equal(one->samples.values(), other->samples.values()));
}

TEST(Zarr, ReadsARegionWhereTheCoordinateDecreases) {
    const Files files{{".zgroup", R"({"zarr_format":2})"},
                      {"f/.zarray", zarray("[5]", "[2]")},
                      {"f/.zattrs", R"({"_ARRAY_DIMENSIONS":["x"]})"},
                      {"f/1", chunkOf({3, 4})},
                      {"x/.zarray", zarray("[5]", "[5]")},
                      {"x/.zattrs", R"({"_ARRAY_DIMENSIONS":["x"]})"},
                      {"x/0", chunkOf({50, 40, 30, 20, 10})}};
    std::set<std::string> opened;
    const auto field =
        readFiles(files, FieldReadOptions{.variable = "f", .region = Box{{20, 0, 0, 0}, {30, 0, 0, 0}}}, &opened);
    ASSERT_TRUE(field) << field.error().message;
    const auto samples = field->samples.values();
    EXPECT_EQ(std::vector(samples.begin(), samples.end()), (std::vector<float>{4, 3}));
    EXPECT_EQ(field->box, (Box{{20, 0, 0, 0}, {30, 0, 0, 0}}));
    EXPECT_TRUE(opened.contains("f/1") && !opened.contains("f/0") && !opened.contains("f/2"));
}

// A region is in the coordinates of the box. If the coordinates of the samples are far from 0, these are counted from
// the least one.
TEST(Zarr, CoordinatesFarFromZeroAreCountedFromTheLeast) {
    const Files files{{".zgroup", R"({"zarr_format":2})"},
                      {"f/.zarray", zarray("[3]", "[3]")},
                      {"f/.zattrs", R"({"_ARRAY_DIMENSIONS":["x"]})"},
                      {"f/0", chunkOf({1, 2, 3})},
                      {"x/.zarray", zarray("[3]", "[3]")},
                      {"x/.zattrs", R"({"_ARRAY_DIMENSIONS":["x"],"units":"m"})"},
                      {"x/0", chunkOf({5'400'000, 5'400'001, 5'400'002})}};
    const auto whole = readFiles(files, "f");
    ASSERT_TRUE(whole) << whole.error().message;
    EXPECT_EQ(whole->box, (Box{{0, 0, 0, 0}, {2, 0, 0, 0}}));
    EXPECT_EQ(whole->units[0], "m");
    ASSERT_EQ(whole->warnings.size(), 1U);
    EXPECT_NE(whole->warnings.front().find("5400000 m"), std::string::npos) << whole->warnings.front();
    const auto part = readFiles(files, FieldReadOptions{.variable = "f", .region = Box{{1, 0, 0, 0}, {2, 0, 0, 0}}});
    ASSERT_TRUE(part) << part.error().message;
    EXPECT_EQ(part->box, (Box{{1, 0, 0, 0}, {2, 0, 0, 0}}));
}

TEST(Zarr, RefusesARegionBeyondTheArray) {
    const Files files = filesInChunks();
    for (const auto& region : {Box{{-2, 0, 0, 0}, {-1, 6, 3, 4}}, Box{{5.5, 0, 0, 0}, {6, 6, 3, 4}}}) {
        const auto field = readFiles(files, FieldReadOptions{.box = Box{{0, 0, 0, 0}, {5, 6, 3, 4}}, .region = region});
        ASSERT_FALSE(field);
        EXPECT_EQ(field.error().code, ErrorCode::out_of_range);
        EXPECT_NE(field.error().message.find("along x from 0 to 5"), std::string::npos) << field.error().message;
    }
}

TEST(Zarr, ReadsTheFinestLevelThatFitsIntoMemory) {
    const std::string image = R"({"multiscales":[{"axes":[{"name":"y"},{"name":"x"}],"datasets":[
        {"path":"0","coordinateTransformations":[{"type":"scale","scale":[1,1]}]},
        {"path":"1","coordinateTransformations":[
            {"type":"scale","scale":[2,2]},{"type":"translation","translation":[0.5,0.5]}]}]}]})";
    const Files files{{".zgroup", R"({"zarr_format":2})"},
                      {".zattrs", image},
                      {"0/.zarray", zarray("[4,8]", "[4,8]")},
                      {"1/.zarray", zarray("[2,4]", "[2,4]")}};
    const Box fine{{0, 0, 0, 0}, {7, 3, 0, 0}}, coarse{{0.5, 0.5, 0, 0}, {6.5, 2.5, 0, 0}};
    const auto read = [&](std::size_t maxInMemory, const std::optional<Box>& region = {}) {
        auto field = readFiles(files, FieldReadOptions{.maxInMemory = maxInMemory, .region = region});
        EXPECT_TRUE(field) << field.error().message;
        return std::move(*field);
    };
    const FieldArray whole = read(32), overview = read(31), coarsest = read(7);
    EXPECT_EQ(whole.box, fine);
    EXPECT_FALSE(whole.isPart);
    EXPECT_EQ(overview.box, coarse);
    EXPECT_TRUE(overview.isPart);
    EXPECT_NE(overview.warnings.at(0).find("of 2 levels, '1' is shown, the finest one"), std::string::npos);
    EXPECT_EQ(coarsest.box, coarse);
    EXPECT_NE(coarsest.warnings.at(0).find("the coarsest one"), std::string::npos);
    const FieldArray left = read(16, Box{{0, 0, 0, 0}, {3, 3, 0, 0}});
    EXPECT_EQ(left.box, (Box{{0, 0, 0, 0}, {3, 3, 0, 0}}));
    EXPECT_EQ(left.shape, (Shape{4, 4, 1, 1}));
    EXPECT_EQ(whole.imageLevel, (MultiscaleImageLevel{0, 2}));
    EXPECT_EQ(overview.imageLevel, (MultiscaleImageLevel{1, 2}));
    EXPECT_EQ(left.imageLevel, (MultiscaleImageLevel{0, 2}));
    const auto named = readFiles(files, FieldReadOptions{.variable = "1"});
    ASSERT_TRUE(named) << named.error().message;
    EXPECT_EQ(named->imageLevel, (MultiscaleImageLevel{1, 2}));
    EXPECT_TRUE(left.isPart);
    const FieldArray first =
        *readFiles(files, FieldReadOptions{.region = Box{{0, 0, 0, 0}, {3, 3, 0, 0}}, .maxInFirstLevel = 15});
    EXPECT_EQ(first.imageLevel, (MultiscaleImageLevel{1, 2, 1}));
    EXPECT_EQ(first.shape, (Shape{3, 2, 1, 1}));
    EXPECT_NE(first.warnings.at(0).find("'1' is shown first; finer ones follow"), std::string::npos);
    // The box of a coarser level does not reach the ends of the box of the finest level.
    const FieldArray end = read(2, Box{{7, 0, 0, 0}, {7, 3, 0, 0}});
    EXPECT_EQ(end.box, (Box{{6.5, 0.5, 0, 0}, {6.5, 2.5, 0, 0}}));
}

// Returns the files of a multiscale image whose levels have 16, 8, 4 and 2 samples.
Files imageOfFourLevels() {
    Files files{{".zgroup", R"({"zarr_format":2})"}};
    std::string levels;
    for (int level = 0; level < 4; ++level) {
        const std::string path = std::to_string(level), size = "[" + std::to_string(16 >> level) + "]";
        files[path + "/.zarray"] = zarray(size, size);
        levels += std::string(level == 0 ? "" : ",") + R"({"path":")" + path + "\"}";
    }
    files[".zattrs"] = R"({"multiscales":[{"axes":[{"name":"x"}],"datasets":[)" + levels + "]}]}";
    return files;
}

TEST(Zarr, ReadsALevelByItsNumberAndSaysHowManyFinerOnesFollow) {
    const Files files = imageOfFourLevels();
    struct Case {
        std::size_t maxInMemory, maxInFirstLevel;
        std::optional<std::uint32_t> level;
        MultiscaleImageLevel expected;
    };
    for (const auto& [maxInMemory, maxInFirstLevel, level, expected] :
         {Case{16, 16, {}, {0, 4, 0}}, Case{16, 4, {}, {2, 4, 2}}, Case{8, 4, {}, {2, 4, 1}},
          Case{8, 99, {}, {1, 4, 0}}, Case{8, 1, {}, {3, 4, 2}}, Case{1, 1, {}, {3, 4, 0}}, Case{8, 4, 1U, {1, 4, 0}},
          Case{16, 4, 1U, {1, 4, 1}}, Case{16, 4, 0U, {0, 4, 0}}}) {
        const auto field = readFiles(
            files, FieldReadOptions{.maxInMemory = maxInMemory, .maxInFirstLevel = maxInFirstLevel, .level = level});
        ASSERT_TRUE(field) << field.error().message;
        EXPECT_EQ(field->imageLevel, expected) << maxInMemory << ' ' << maxInFirstLevel;
        EXPECT_EQ(field->shape[0], 16U >> expected.level);
        EXPECT_EQ(field->isPart, expected.level > 0);
    }
    const auto large = readFiles(files, FieldReadOptions{.maxInMemory = 8, .level = 0U});
    ASSERT_FALSE(large);
    EXPECT_EQ(large.error().code, ErrorCode::too_large);
    const auto missing = readFiles(files, FieldReadOptions{.level = 4U});
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, ErrorCode::not_found);
    const auto array = readFiles(Files{{".zarray", zarray("[2]", "[2]")}}, FieldReadOptions{.level = 0U});
    EXPECT_TRUE(array) << "the folder is an array";
}

}  // namespace
}  // namespace oval4d::fields::test
