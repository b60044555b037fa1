// Tests of object records that earlier versions have stored. The records in this file must never change.

#include "store/object_record_v1.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "fields/array/array_function.hpp"
#include "fields/field.hpp"
#include "geometry/point_cloud.hpp"
#include "geometry/surface_mesh.hpp"
#include "polytopes/polytope.hpp"
#include "store/cbor.hpp"
#include "store/object_codec.hpp"

namespace oval4d::store {
namespace {

using nlohmann::json;

slicing::Object decoded(const json& record) { return decodeObjectRecord(encodeCbor(record)); }

json samples(const std::vector<float>& values) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(values.data());
    return json::binary(json::binary_t::container_type(bytes, bytes + values.size() * sizeof(float)));
}

json polytope() {
    return json::parse(R"([1, "5-cell", [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1],[-1,-1,-1,-1]],
        [[0,1,2],[0,1,3],[0,1,4],[0,2,3],[0,2,4],[0,3,4],[1,2,3],[1,2,4],[1,3,4],[2,3,4]],
        [[0,1,3,6],[0,2,4,7],[1,2,5,8],[3,4,5,9],[6,7,8,9]], [0,1,0,1,1]])");
}

json array() {
    return json::array(
        {1, "run", samples({1, 2, 3, 4}), json::parse("[[-1,-1,-1,-1],[3,1,1,1]]"), json::array({4, 1, 1, 1})});
}

TEST(ObjectRecordV1, ReadsPolytopesAndWhereTheyWere) {
    for (const bool isMoved : {false, true}) {
        const json record =
            isMoved ? json::array({1, json::array({json::parse("[[1,2,3,4]]"), polytope()})}) : polytope();
        const slicing::Object object = decoded(record);
        const auto& read = *std::get<slicing::PolytopePtr>(object);
        EXPECT_EQ(read.name, "5-cell");
        EXPECT_EQ(read.vertices.size(), 5U);
        EXPECT_EQ(read.edges.size(), 10U);
        EXPECT_EQ(read.cells.size(), 5U);
        EXPECT_EQ(read.cellTypes.size(), 2U);
        EXPECT_EQ(read.originInFile, isMoved ? glm::dvec4(1, 2, 3, 4) : glm::dvec4(0));
    }
}

TEST(ObjectRecordV1, ReadsCloudsAndSurfaces) {
    const slicing::Object cloud = decoded(json::parse(R"([1, "c", [[1,0,0,0],[0,2,0,0]], [0,0.5]])"));
    EXPECT_EQ(std::get<slicing::CloudPtr>(cloud)->points.at(1), glm::dvec4(0, 2, 0, 0));
    EXPECT_EQ(std::get<slicing::CloudPtr>(cloud)->radii, (std::vector<double>{0, 0.5}));
    const std::string text = R"([1, "s", [[1,0,0,0],[0,1,0,0],[0,0,1,0]], [[0,1,2]], null, null, null, )";
    const slicing::Object surface = decoded(json::parse(text + "null]"));
    EXPECT_EQ(std::get<slicing::SurfacePtr>(surface)->name, "s");
    EXPECT_EQ(std::get<slicing::SurfacePtr>(surface)->faces.size(), 1U);
    EXPECT_THROW(decoded(json::parse(text + "1]")), UnreadableRecord) << "of a later version";
}

TEST(ObjectRecordV1, ReadsFormulas) {
    json record = json::parse(R"([1, "f", "q-a; a=2, q=x*y", [[-1,-1,-1,-1],[3,1,1,1]], []])");
    const slicing::Object object = decoded(record);
    const fields::Field& field = *slicing::fieldIn(object);
    EXPECT_EQ(field.name, "f");
    EXPECT_FALSE(field.formula.empty());
    EXPECT_EQ(field.box.max.x, 3);
    EXPECT_FALSE(field.second);
    record.push_back("a*q");
    record.push_back("field");
    const slicing::Object withSecond = decoded(record);
    ASSERT_TRUE(slicing::fieldIn(withSecond)->second);
    EXPECT_FALSE(slicing::fieldIn(withSecond)->second->formula.empty());
    record.push_back(json::parse(R"(["m","","","",["",""]])"));
    record.push_back(json::parse(R"(["",""])"));
    EXPECT_THROW(decoded(record), UnreadableRecord) << "a formula with units";
}

TEST(ObjectRecordV1, ReadsArrays) {
    json record = array();
    const slicing::Object alone = decoded(record);
    const fields::Field& field = *slicing::fieldIn(alone);
    EXPECT_EQ(field.array->shape(), (fields::Shape{4, 1, 1, 1}));
    EXPECT_EQ(field.array->samples()[3], 4);
    EXPECT_EQ(field.array->box().max.x, 3);
    EXPECT_FALSE(field.second);

    record.push_back(json::array({"p", samples({5, 6, 7, 8})}));
    record.push_back("field");
    const slicing::Object withSecond = decoded(record);
    const fields::SecondFunction* second = slicing::fieldIn(withSecond)->second.get();
    ASSERT_TRUE(second && second->array);
    EXPECT_EQ(second->variable, "p");
    EXPECT_EQ(second->array->samples()[0], 5);

    record.push_back(json::parse(R"(["m","","km","s",["temperature","K"]])"));
    record.push_back(json::parse(R"(["pressure","Pa"])"));
    const slicing::Object withUnits = decoded(record);
    EXPECT_EQ(slicing::fieldIn(withUnits)->units, (fields::AxisUnits{"m", "", "km", "s"}));
    EXPECT_EQ(slicing::fieldIn(withUnits)->quantity, (fields::Quantity{"temperature", "K"}));
    EXPECT_EQ(slicing::fieldIn(withUnits)->second->quantity, (fields::Quantity{"pressure", "Pa"}));

    record.at(5) = nullptr;
    EXPECT_FALSE(slicing::fieldIn(decoded(record))->second);
    record.at(5) = "x*y";
    EXPECT_FALSE(slicing::fieldIn(decoded(record))->second->formula.empty());
    record.at(2) = samples({1, 2, 3});
    EXPECT_THROW(decoded(record), UnreadableRecord);
}

TEST(ObjectRecordV1, ReadsTheSourcesOfFieldsInFiles) {
    for (const bool isPart : {false, true}) {
        json record = json::parse(R"([1, "f", ["large.zarr", "zarr", "tzyx", "v", "x", "p", [[-1,0,0,0],[1,1,1,1]]]])");
        if (isPart) record.at(2).push_back(json::parse("[[0,0,0,0],[1,1,0,1]]"));
        EXPECT_TRUE(refersToFile(encodeCbor(record)));
        std::optional<session::LoadObject> opened;
        const slicing::Object field = decodeObjectRecord(encodeCbor(record), [&](const session::LoadObject& load) {
            opened = load;
            return Result<slicing::Object>(decoded(array()));
        });
        ASSERT_TRUE(opened);
        EXPECT_EQ(opened->name, "f");
        EXPECT_EQ(opened->dataName, "large.zarr");
        EXPECT_EQ(opened->format, "zarr");
        EXPECT_EQ(opened->axes, "tzyx");
        EXPECT_EQ(opened->variable, "v");
        EXPECT_EQ(opened->secondFormula, "x");
        EXPECT_EQ(opened->secondVariable, "p");
        ASSERT_TRUE(opened->box);
        EXPECT_EQ(opened->box->min.x, -1);
        ASSERT_EQ(opened->region.has_value(), isPart);
        EXPECT_EQ(slicing::infoOf(field).name, "run");
    }
}

TEST(ObjectRecordV1, RefusesOtherRecords) {
    for (const char* text :
         {"[1]", "[1, 2]", "[1, [[], []]]", "[1, [[[0,0,0,0],[0,0,0,0]], []]]", R"([1, "a", 3, 4, 5, 6, 7, 8, 9, 10])",
          R"([1, [[[0,0,0,0]], [1, [[[0,0,0,0]], []]]]])", R"([1, "f", [1, 2]])", R"([1, "a", "x", [[0,0,0,0]], []])"})
        EXPECT_THROW(decoded(json::parse(text)), UnreadableRecord) << text;
    json moved = json::array({1, json::array({json::parse("[[1,2,3,4]]"), array()})});
    EXPECT_THROW(decoded(moved), UnreadableRecord) << "a field that was moved";
}

}  // namespace
}  // namespace oval4d::store
