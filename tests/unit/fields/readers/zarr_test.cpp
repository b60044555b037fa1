#include "fields/readers/zarr.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "unit/fields/readers/files.hpp"

namespace oval4d::fields::test {
namespace {

using Files = std::map<std::string, std::string>;  // the contents of each file by its path

Result<FieldArray> readFiles(const Files& files, const std::string& variable = "") {
    const FolderFileReader folder = [&](const std::string& path) -> Result<std::optional<FileContents>> {
        const auto found = files.find(path);
        if (found == files.end()) return std::optional<FileContents>();
        return std::optional(FileContents::copyOf(found->second));
    };
    return readZarr(folder, {.variable = variable});
}

// The .zarray file of an array of 32-bit floats in one chunk. `sizes` are the numbers in a JSON list.
std::string zarray(const std::string& shape, const std::string& chunk, const std::string& fill = "0") {
    return R"({"zarr_format":2,"dtype":"<f4","order":"C","filters":null,"compressor":null,"shape":)" + shape +
           R"(,"chunks":)" + chunk + R"(,"fill_value":)" + fill + "}";
}

std::string chunkOf(const std::vector<float>& numbers) {
    std::string bytes;
    for (const float number : numbers) bytes += bytesOf(number);
    return bytes;
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
    // NaN; too few and too many bytes; without padding; not Base64; a type that xarray does not encode.
    for (const std::string fill : {"AAAAAAAA+H8=", "AAAAAICHww==", "AAAAAICHw8AA", "AAAAAICHw8A", "-Infinity", "?", ""})
        EXPECT_EQ(samples("float32", fill)[1], -9999) << fill;
    EXPECT_EQ(samples("int32", "AAAAAICHw8A=")[1], -9999);
}

}  // namespace
}  // namespace oval4d::fields::test
