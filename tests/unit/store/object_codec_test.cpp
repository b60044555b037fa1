// The records of surfaces and fields. codec_test.cpp has tests of the records of polytopes.

#include "store/object_codec.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "fields/array_field.hpp"
#include "fields/formula_field.hpp"
#include "geometry/surface_mesh.hpp"
#include "store/cbor.hpp"

namespace oval4d::store {
namespace {

TEST(ObjectCodec, BringsSurfacesBack) {
    geometry::JaggedArray faces;
    faces.add(std::vector<std::uint32_t>{0, 1, 2});
    faces.add(std::vector<std::uint32_t>{2, 1, 0, 3});
    geometry::SurfaceMesh surface = geometry::makeSurfaceMesh(
        "s", {{1, 0, 0, 0}, {0, 1, 0, 0.25}, {0, 0, 1, -1.0 / 3}, {-1, 0, 2, 1e-9}}, std::move(faces));
    for (const glm::dvec4& origin : {glm::dvec4(0), glm::dvec4(1, 2, 3, 1e6)}) {
        surface.originInFile = origin;
        const std::string record = encodeObjectRecord(std::make_shared<const geometry::SurfaceMesh>(surface));
        EXPECT_FALSE(refersToFile(record));
        const slicing::Object back = decodeObjectRecord(record);
        EXPECT_EQ(encodeObjectRecord(back), record);
        const auto& copy = *std::get<slicing::SurfacePtr>(back);
        EXPECT_EQ(copy.name, "s");
        EXPECT_EQ(copy.vertices, surface.vertices);
        EXPECT_EQ(copy.faces, surface.faces);
        EXPECT_EQ(copy.edges, surface.edges);
        EXPECT_EQ(copy.originInFile, origin);
    }
}

TEST(ObjectCodec, RefusesInvalidSurfaces) {
    const auto recordOf = [](const std::string& faces, const std::string& last) {
        return encodeCbor(nlohmann::json::parse(R"([1,"s",[[1,0,0,0],[0,1,0,0],[0,0,1,0]],)" + faces +
                                                ",null,null,null," + last + ']'));
    };
    EXPECT_EQ(recordOf("[[0,1,2]]", "null")[0], '\x88') << "eight members, unlike the records of all other kinds";
    EXPECT_NO_THROW(decodeObjectRecord(recordOf("[[0,1,2]]", "null")));
    EXPECT_THROW(decodeObjectRecord(recordOf("[[0,1,2]]", "1")), UnreadableRecord) << "of a later version";
    for (const char* faces : {"[]", "[[0,1]]", "[[0,1,3]]", "[[0,1,1]]", "[[0,1,-1]]", "[0,1,2]"})
        EXPECT_THROW(decodeObjectRecord(recordOf(faces, "null")), UnreadableRecord) << faces;
}

TEST(ObjectCodec, FieldsKeepTheirSecondFunction) {
    fields::FieldArray array;
    array.shape = {2, 2, 2, 3};
    array.box = {glm::dvec4(-1), glm::dvec4(1)};
    std::vector<float> samples(24);
    for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = static_cast<float>(i);
    array.samples = fields::SampleStorage(std::move(samples));
    fields::Field twoArrays = *fields::fieldFromArray("run", array), withFormula = twoArrays;
    std::string longName;  // of 256 characters, but more bytes
    while (longName.size() < 512) longName += "é";
    EXPECT_FALSE(fields::setSecondArray(twoArrays, array, longName));
    EXPECT_FALSE(fields::setSecondFormula(withFormula, "x + a; a=2"));
    const fields::Field formula = *fields::fieldFromFormula("formula", "q - a; a=2, q=x*y", fields::kFormulaBox, "a*q");
    for (const fields::Field& field : {twoArrays, withFormula, formula}) {
        const std::string record = encodeObjectRecord(std::make_shared<const fields::Field>(field));
        const slicing::Object back = decodeObjectRecord(record);
        EXPECT_EQ(encodeObjectRecord(back), record);
        const fields::Field& copy = *slicing::fieldIn(back);
        ASSERT_TRUE(copy.second);
        EXPECT_EQ(copy.second->formula, field.second->formula);
        EXPECT_EQ(copy.second->variable, field.second->variable);
        EXPECT_EQ(copy.second->array != nullptr, field.second->array != nullptr);
    }
    EXPECT_THROW(
        decodeObjectRecord(encodeCbor({kRecordVersion, "a", "x", nlohmann::json::parse("[[0,0,0,0],[1,1,1,1]]"),
                                       nlohmann::json::array(), "y*", "field"})),
        std::runtime_error);
}

// A field of an array with units, and with a second array if `hasSecond` is true.
fields::Field fieldWithUnits(bool hasSecond) {
    fields::FieldArray array;
    array.shape = {2, 1, 1, 1};
    array.box = {glm::dvec4(-1), glm::dvec4(1)};
    array.samples = fields::SampleStorage(std::vector<float>{1, 2});
    array.units = {"m", "", "km", "s"};
    array.quantity = {"temperature", "K"};
    fields::Field field = *fields::fieldFromArray("run", array);
    array.quantity = {"pressure", "Pa"};
    if (hasSecond) {
        EXPECT_FALSE(fields::setSecondArray(field, array, "p"));
    }
    return field;
}

TEST(ObjectCodec, FieldsKeepTheirUnits) {
    for (const bool hasSecond : {false, true}) {
        const fields::Field field = fieldWithUnits(hasSecond);
        const std::string record = encodeObjectRecord(std::make_shared<const fields::Field>(field));
        EXPECT_EQ(record[0], '\x89') << "nine members, unlike the records of all other kinds";
        EXPECT_FALSE(refersToFile(record));
        const slicing::Object back = decodeObjectRecord(record);
        EXPECT_EQ(encodeObjectRecord(back), record);
        const fields::Field& copy = *slicing::fieldIn(back);
        EXPECT_EQ(copy.units, field.units);
        EXPECT_EQ(copy.quantity, field.quantity);
        ASSERT_EQ(copy.second != nullptr, hasSecond);
        if (hasSecond) {
            EXPECT_EQ(copy.second->quantity, field.second->quantity);
        }
    }
}

TEST(ObjectCodec, FieldsWithoutUnitsAreStoredAsBefore) {
    fields::Field field = fieldWithUnits(true);
    field.units = {};
    field.quantity = {};
    fields::SecondFunction second = *field.second;
    second.quantity = {};
    field.second = std::make_shared<const fields::SecondFunction>(second);
    EXPECT_EQ(encodeObjectRecord(std::make_shared<const fields::Field>(field))[0], '\x87');
    field.second.reset();
    EXPECT_EQ(encodeObjectRecord(std::make_shared<const fields::Field>(field))[0], '\x85');
}

TEST(ObjectCodec, RefusesInvalidUnits) {
    using nlohmann::json;
    const json valid = json::from_cbor(encodeObjectRecord(std::make_shared<const fields::Field>(fieldWithUnits(true))));
    const auto refusal = [&](const json::json_pointer& at, const json& member) {
        json record = valid;
        record[at] = member;
        try {
            decodeObjectRecord(encodeCbor(record));
        } catch (const UnreadableRecord& fault) {
            return std::string(fault.what());
        }
        return std::string();
    };
    EXPECT_EQ(refusal(json::json_pointer("/7/0"), "cm"), "");
    for (const char* text : {"/7/0", "/7/3", "/7/4/0", "/7/4/1", "/8/0", "/8/1"}) {
        const json::json_pointer at(text);
        for (const std::string& wrong : {std::string(65, 'm'), std::string("K\n")})
            EXPECT_NE(refusal(at, wrong).find("too long or is not printable"), std::string::npos) << text;
        EXPECT_NE(refusal(at, 1), "") << text;
    }
    EXPECT_NE(refusal(json::json_pointer("/7/5"), "m").find("later version"), std::string::npos);
    EXPECT_NE(refusal(json::json_pointer("/8/2"), "m").find("later version"), std::string::npos);
    EXPECT_NE(refusal(json::json_pointer("/7"), json::array()), "");
    EXPECT_NE(refusal(json::json_pointer("/2"), "x").find("a formula has units"), std::string::npos);
    std::string record = encodeCbor(valid);
    const std::size_t at = record.find("km");
    ASSERT_NE(at, std::string::npos);
    record[at] = '\xff';
    EXPECT_THROW(decodeObjectRecord(record), UnreadableRecord) << "not UTF-8";
}

}  // namespace
}  // namespace oval4d::store
