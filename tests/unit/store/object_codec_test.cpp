// Tests of the records of objects. codec_test.cpp has further tests of polytopes, and object_record_v1_test.cpp tests
// records of earlier versions.

#include "store/object_codec.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <nlohmann/json.hpp>

#include "fields/array_field.hpp"
#include "fields/field_definition.hpp"
#include "fields/formula_field.hpp"
#include "geometry/point_cloud.hpp"
#include "geometry/surface_mesh.hpp"
#include "polytopes/polytope.hpp"
#include "serialization/stored_members.hpp"
#include "store/cbor.hpp"
#include "store/member_codec.hpp"

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
    const auto recordOf = [](const std::string& faces, const std::string& cells) {
        return encodeCbor(nlohmann::json::parse(R"([2,3,false,[[["s",[0,0,0,0]],[[1,0,0,0],[0,1,0,0],[0,0,1,0]],)" +
                                                faces + ',' + cells + ",[]]]]"));
    };
    EXPECT_NO_THROW(decodeObjectRecord(recordOf("[[0,1,2]]", "[]")));
    EXPECT_THROW(decodeObjectRecord(recordOf("[[0,1,2]]", "[[0]]")), UnreadableRecord);
    for (const char* faces : {"[]", "[[0,1]]", "[[0,1,3]]", "[[0,1,1]]", "[[0,1,-1]]", "[0,1,2]", "7"})
        EXPECT_THROW(decodeObjectRecord(recordOf(faces, "[]")), UnreadableRecord) << faces;
}

TEST(ObjectCodec, FieldsKeepTheirSecondFunction) {
    fields::FieldArray array;
    array.shape = {2, 2, 2, 3};
    array.box = {glm::dvec4(-1), glm::dvec4(1)};
    std::vector<float> samples(24);
    for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = static_cast<float>(i);
    array.samples = fields::SampleStorage(std::move(samples));
    fields::Field twoArrays = *fields::fieldFromArray("run", array), withFormula = twoArrays;
    std::string longName;  // has 256 characters, but more bytes
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
    EXPECT_THROW(decodeObjectRecord(encodeCbor(nlohmann::json::parse(
                     R"([2,2,false,[["a",[0,0,0,0]],null,"x",[[0,0,0,0],[1,1,1,1]],null,["y*","",null]]])"))),
                 NewerVersionRecord);
}

// Returns a field of an array with units. If `hasSecond` is true, the field has a second array.
fields::Field fieldWithUnits(bool hasSecond) {
    fields::FieldArray array;
    array.shape = {2, 1, 1, 1};
    array.box = {glm::dvec4(-2), glm::dvec4(2)};
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
    EXPECT_EQ(refusal(json::json_pointer("/3/4/3/0"), "cm"), "");
    for (const char* text : {"/3/4/3/0", "/3/4/3/3", "/3/4/4/0", "/3/4/4/1", "/3/5/2/4/0", "/3/5/2/4/1"}) {
        const json::json_pointer at(text);
        for (const std::string& wrong : {std::string(65, 'm'), std::string("K\n")})
            EXPECT_NE(refusal(at, wrong).find("too long or is not printable"), std::string::npos) << text;
        EXPECT_NE(refusal(at, 1), "") << text;
    }
    EXPECT_NE(refusal(json::json_pointer("/3/4/3/4"), "m").find("later version"), std::string::npos);
    EXPECT_NE(refusal(json::json_pointer("/3/4/4/2"), "m").find("later version"), std::string::npos);
    EXPECT_NE(refusal(json::json_pointer("/3/4/3"), json::array()), "");
    EXPECT_NE(refusal(json::json_pointer("/3/2"), "x").find("both a formula and an array"), std::string::npos);
    EXPECT_NE(refusal(json::json_pointer("/3/4/0/0"), 3).find("samples of an array are missing"), std::string::npos);
    std::string record = encodeCbor(valid);
    const std::size_t at = record.find("km");
    ASSERT_NE(at, std::string::npos);
    record[at] = '\xff';
    EXPECT_THROW(decodeObjectRecord(record), UnreadableRecord) << "not UTF-8";
}

// Returns a field in the data folder, whose samples are not stored.
fields::Field fieldInFile() {
    fields::Field field = fieldWithUnits(false);
    field.source = std::make_shared<const fields::FieldFileSource>(fields::FieldFileSource{
        "large.zarr", "zarr", "tzyx", "v", "x*y", "p", fields::Box{glm::dvec4(-3), glm::dvec4(3)},
        fields::Box{glm::dvec4(0), glm::dvec4(1, 1, 0, 1)}});
    return field;
}

TEST(ObjectCodec, FieldsInFilesKeepTheirSource) {
    const std::string record = encodeObjectRecord(std::make_shared<const fields::Field>(fieldInFile()));
    EXPECT_TRUE(refersToFile(record));
    std::optional<session::LoadObject> opened;
    const slicing::Object back = decodeObjectRecord(record, [&](const session::LoadObject& load) {
        opened = load;
        return Result<slicing::Object>(std::make_shared<const fields::Field>(fieldInFile()));
    });
    EXPECT_EQ(encodeObjectRecord(back), record);
    session::LoadObject expected;
    expected.name = "run";
    expected.dataName = "large.zarr";
    expected.format = "zarr";
    expected.axes = "tzyx";
    expected.variable = "v";
    expected.secondFormula = "x*y";
    expected.secondVariable = "p";
    expected.box = fields::Box{glm::dvec4(-3), glm::dvec4(3)};
    expected.region = fields::Box{glm::dvec4(0), glm::dvec4(1, 1, 0, 1)};
    ASSERT_TRUE(opened);
    EXPECT_EQ(*opened, expected);
    EXPECT_THROW(decodeObjectRecord(record), UnreadableRecord) << "there is no data folder";
    auto hidden = nlohmann::json::from_cbor(record);
    hidden.at(2) = false;
    EXPECT_FALSE(refersToFile(encodeCbor(hidden)));
    EXPECT_THROW(
        decodeObjectRecord(encodeCbor(hidden),
                           [](const session::LoadObject&) {
                               return Result<slicing::Object>(std::make_shared<const fields::Field>(fieldInFile()));
                           }),
        UnreadableRecord);
}

// Returns objects of all kinds.
std::vector<slicing::Object> objectsOfAllKinds() {
    geometry::JaggedArray faces, cells;
    for (const auto& face : std::vector<std::vector<std::uint32_t>>{{0, 1, 2},
                                                                    {0, 1, 3},
                                                                    {0, 1, 4},
                                                                    {0, 2, 3},
                                                                    {0, 2, 4},
                                                                    {0, 3, 4},
                                                                    {1, 2, 3},
                                                                    {1, 2, 4},
                                                                    {1, 3, 4},
                                                                    {2, 3, 4}})
        faces.add(face);
    for (const auto& cell :
         std::vector<std::vector<std::uint32_t>>{{0, 1, 3, 6}, {0, 2, 4, 7}, {1, 2, 5, 8}, {3, 4, 5, 9}, {6, 7, 8, 9}})
        cells.add(cell);
    const std::vector<glm::dvec4> vertices{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}, {-1, -1, -1, -1}};
    polytopes::Polytope polytope = polytopes::makePolytope("polytope", vertices, faces, cells, {0, 1, 0, 1, 1});
    geometry::SurfaceMesh surface = geometry::makeSurfaceMesh("surface", vertices, faces);
    geometry::PointCloud cloud = geometry::makePointCloud("cloud", vertices, {0, 1, 0.5, 0, 2});
    for (geometry::ObjectInfo* info :
         {static_cast<geometry::ObjectInfo*>(&polytope), static_cast<geometry::ObjectInfo*>(&surface),
          static_cast<geometry::ObjectInfo*>(&cloud)})
        info->originInFile = {1, 2, 3, 4};
    fields::Field part = fieldWithUnits(true);
    part.isPart = true;
    part.imageLevel = {2, 3, 1};
    const fields::Field formula =
        *fields::fieldFromFormula("formula", "x+w", fields::Box{glm::dvec4(-2), glm::dvec4(3)}, "y");
    return {
        std::make_shared<const polytopes::Polytope>(polytope), std::make_shared<const geometry::SurfaceMesh>(surface),
        std::make_shared<const geometry::PointCloud>(cloud),   std::make_shared<const fields::Field>(part),
        std::make_shared<const fields::Field>(formula),        std::make_shared<const fields::Field>(fieldInFile())};
}

TEST(ObjectCodec, KindsKeepTheirNumbers) {
    std::map<std::string, unsigned> numbers;
    for (const slicing::Object& object : objectsOfAllKinds())
        numbers[slicing::infoOf(object).name] =
            nlohmann::json::from_cbor(encodeObjectRecord(object)).at(1).get<unsigned>();
    EXPECT_EQ(numbers, (std::map<std::string, unsigned>{
                           {"polytope", 0}, {"cloud", 1}, {"formula", 2}, {"run", 2}, {"surface", 3}}));
}

TEST(ObjectCodec, RefusesRecordsOfLaterVersions) {
    using nlohmann::json;
    const auto refusal = [](const json& record) {
        try {
            decodeObjectRecord(encodeCbor(record));
        } catch (const NewerVersionRecord& fault) {
            return std::string(fault.what());
        }
        return std::string();
    };
    for (const slicing::Object& object : objectsOfAllKinds()) {
        const json record = json::from_cbor(encodeObjectRecord(object));
        json other = record;
        other.at(0) = 3;
        EXPECT_NE(refusal(other).find("version 3, and this program reads version 1 to 2"), std::string::npos);
        other = record;
        other.at(1) = 4;
        EXPECT_NE(refusal(other).find("no kind of object"), std::string::npos);
        for (const char* place : {"", "/3", "/3/0"}) {
            other = record;
            other.at(json::json_pointer(place)).push_back(1);
            EXPECT_NE(refusal(other).find("a later version"), std::string::npos) << place;
        }
    }
}

// A visitor that collects the values of all stored members, by their places. The place "/0/1" means member 1 of member
// 0.
class MemberValues {
  public:
    using Values = std::map<std::string, std::set<std::string>>;

    MemberValues(std::string place, Values& values) : place_(std::move(place)), values_(values) {}

    template <typename T, typename... Ranges>
    void member(std::size_t number, const T& value, Ranges... /*range*/) {
        add(place_ + '/' + std::to_string(number), value);
    }
    template <typename T, typename... Ranges>
    void memberAddedLater(std::size_t number, const T& value, Ranges... /*range*/) {
        add(place_ + '/' + std::to_string(number), value);
    }
    template <typename T>
    void recomputableMember(const T& /*value*/) {}

  private:
    template <typename T>
    void add(const std::string& place, const T& value) {
        if constexpr (requires(MemberValues& visit) { visitStoredMembers(value, visit); }) {
            MemberValues members(place, values_);
            visitStoredMembers(value, members);
        } else {
            MemberWriter writer;
            writer.member(0, value);
            values_[place].insert(writer.takeArray().dump());
        }
    }
    template <typename T>
    void add(const std::string& place, const std::optional<T>& value) {
        if (value) add(place, *value);
    }

    std::string place_;
    Values& values_;
};

// No member of an object is lost when the object is decoded and encoded again. The test notices a loss only if some
// object has another value of the member than an empty object.
TEST(ObjectCodec, LosesNoMember) {
    const auto open = [](const session::LoadObject&) {
        return Result<slicing::Object>(std::make_shared<const fields::Field>(fieldInFile()));
    };
    MemberValues::Values values;
    const auto collect = [&](const std::string& kind, const auto& stored) {
        MemberValues visit(kind, values);
        visitStoredMembers(stored, visit);
    };
    const auto collectFrom = [&](const auto& data) {
        if constexpr (std::is_same_v<decltype(data), const slicing::PolytopePtr&>) {
            collect("polytope", *data);
        } else if constexpr (std::is_same_v<decltype(data), const slicing::SurfacePtr&>) {
            collect("surface", *data);
        } else if constexpr (std::is_same_v<decltype(data), const slicing::CloudPtr&>) {
            collect("cloud", *data);
        } else {
            collect("field", fields::definitionOf(*data));
        }
    };
    std::set<std::size_t> kinds;
    for (const slicing::Object& object : objectsOfAllKinds()) {
        const std::string record = encodeObjectRecord(object);
        EXPECT_EQ(encodeObjectRecord(decodeObjectRecord(record, open)), record) << slicing::infoOf(object).name;
        std::visit(collectFrom, object);
        kinds.insert(object.index());
    }
    ASSERT_EQ(kinds.size(), std::variant_size_v<slicing::Object>);
    collect("polytope", polytopes::Polytope());
    collect("surface", geometry::SurfaceMesh());
    collect("cloud", geometry::PointCloud());
    fields::FieldDefinition empty;
    fields::FieldFileSource& source = empty.source.emplace();
    source.box.emplace();
    source.region.emplace();
    empty.array.emplace();
    empty.second.emplace().array.emplace();
    collect("field", empty);
    // These members are always empty: the cells of a surface; the origin of a field; of the second array, the units,
    // whether it is a part, and the levels.
    const std::set<std::string> unused{"surface/0/3", "surface/0/4",   "field/0/1",     "field/5/2/3",
                                       "field/5/2/5", "field/5/2/6/0", "field/5/2/6/1", "field/5/2/6/2"};
    for (const auto& [place, found] : values)
        EXPECT_EQ(found.size() > 1, !unused.contains(place)) << place << ": an object needs another value";
}

// If a struct with a base class gets a new member, the static_assert beside the struct fails.
struct Base {
    std::string name;
    bool isSmall = true;
};
struct WithoutMembers : Base {};
struct WithTwoMembers : Base {
    std::shared_ptr<const int> pointer;
    bool isLarge = false;  // may lie in the padding of another member
};
static_assert(serialization::HasOwnMembers<WithoutMembers, Base, 0>);
static_assert(!serialization::HasOwnMembers<WithoutMembers, Base, 1>);
static_assert(serialization::HasOwnMembers<WithTwoMembers, Base, 2>);
static_assert(!serialization::HasOwnMembers<WithTwoMembers, Base, 1>);
static_assert(!serialization::HasOwnMembers<WithTwoMembers, Base, 3>);

}  // namespace
}  // namespace oval4d::store
