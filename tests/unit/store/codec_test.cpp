#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fields/array_field.hpp"
#include "fields/formula_field.hpp"
#include "geometry/surface_mesh.hpp"
#include "session/settings.hpp"
#include "store/cbor.hpp"
#include "store/object_list.hpp"
#include "unit/session/setting_values.hpp"
#include "unit/store/support.hpp"

namespace oval4d::store {
namespace {

using session::Session;

/// Stores objects in encoded form.
class ObjectTable {
  public:
    ObjectKeyLookup keyOf = [this](const slicing::Object& object) {
        const auto [found, isNew] =
            keys_.try_emplace(slicing::infoOf(object).serial, "key" + std::to_string(keys_.size()));
        if (isNew) bytes_[found->second] = encodeObjectRecord(object);
        return found->second;
    };
    ObjectLookup objectOf = [this](const std::string& key) {
        auto& object = built_[key];
        if (!object && bytes_.contains(key)) object = decodeObjectRecord(bytes_[key]);
        return object;
    };
    std::size_t size() const { return bytes_.size(); }

  private:
    std::map<std::uint64_t, std::string> keys_;
    std::map<std::string, std::string> bytes_;
    std::map<std::string, std::optional<slicing::Object>> built_;
};

TEST(Codec, DecodesWhatItEncodes) {
    std::mt19937 random(4);
    std::size_t own = 0;
    for (int round = 0; round < 60; ++round) {
        Session session;
        applyRandomCommands(session, random, round);
        ObjectTable table;
        const Session back =
            decodeSession(encodeWhole(session, 1000, table.keyOf), "", table.objectOf, support::cache());
        EXPECT_TRUE(same(session, back)) << "round " << round;
        own += table.size();
    }
    EXPECT_GT(own, 10U) << "the sessions have loaded objects";
}

TEST(Codec, LosesNoSetting) {
    for (const session::SettingValue& setting : session::settingValues()) {
        const Session session = sessionWith(setting);
        ObjectTable table;
        const Session back = decodeSession(encodeWhole(session, 10, table.keyOf), "", table.objectOf, support::cache());
        EXPECT_TRUE(setting.isIn(back.current)) << setting.name;
    }
}

TEST(Codec, AppliesTheHead) {
    std::mt19937 random(5);
    for (int round = 0; round < 40; ++round) {
        Session session;
        ObjectTable table;
        applyRandomCommands(session, random, 20);
        const std::string whole = encodeWhole(session, 1000, table.keyOf);
        const Session before = session;
        applyRandomCommands(session, random, round % 5);
        const Session back = decodeSession(whole, encodeHead(session, table.keyOf), table.objectOf, support::cache());
        EXPECT_EQ(back.revision, session.revision);
        if (session.revision == before.revision) {
            EXPECT_TRUE(same(before, back));
            continue;
        }
        Session bare, expected;
        bare.current = back.current;
        expected.current = session.current;
        EXPECT_TRUE(same(expected, bare));
        ASSERT_EQ(back.undoSteps.size(), before.undoSteps.size() + 1)
            << "one undo step leads back to the state of `whole`";
        bare.current = back.undoSteps.back();
        expected.current = before.current;
        EXPECT_TRUE(same(expected, bare));
    }
}

TEST(Codec, ReadsRecordsOfVersionsWithFewerParts) {
    Session session;
    session.current.look.parts.bars = session.current.look.parts.labels = false;
    session.current.look.projection = {scene::ProjectionKind::orthogonal, 2};
    session.current.look.thickness = session.current.look.opacity = 2;
    session.current.slices.offset = 0.1;
    session.current.ongoingTurnToward = session::OngoingTurnToward{{}, 1};
    ObjectTable table;
    auto record = nlohmann::json::from_cbor(encodeWhole(session, 10, table.keyOf));
    nlohmann::json& look = record.at(3).at(5);  // of the current state
    nlohmann::json& flags = look.at(1);
    ASSERT_EQ(flags.size(), scene::kParts.size());
    const auto shorten = [](nlohmann::json& members, std::size_t size) {
        while (members.size() > size) members.erase(size);
    };
    shorten(flags, 4);               // 0.1.0 knew faces, bars, balls and coordinates,
    shorten(look, 6);                // no projection, no thickness and no opacity,
    shorten(record.at(3).at(4), 3);  // no offset,
    shorten(record.at(3), 8);        // no turn toward an element and no frame of reference
    const Session back = decodeSession(encodeCbor(record), "", table.objectOf, support::cache());
    EXPECT_FALSE(back.current.look.parts.bars);
    EXPECT_TRUE(back.current.look.parts.faces && back.current.look.parts.labels && back.current.look.parts.back);
    EXPECT_FALSE(back.current.look.parts.projectionFaces || back.current.look.parts.allSections);
    EXPECT_EQ(back.current.look.projection, scene::ProjectionSettings{});
    EXPECT_EQ(back.current.look.thickness, 1);
    EXPECT_EQ(back.current.look.opacity, 1);
    EXPECT_EQ(back.current.slices.offset, 0);
    EXPECT_FALSE(back.current.ongoingTurnToward);
    EXPECT_EQ(back.current.referenceFrame, geometry::ReferenceFrame{});
    EXPECT_EQ(back.current.object, back.current.source);
}

// If a record with an unknown member were read, the member would be lost when the session is stored again.
TEST(Codec, RefusesMembersOfLaterVersions) {
    using nlohmann::json;
    Session session;
    session::line(session, "set pace=2");
    session.current.look.highlight = slicing::Element{slicing::ElementKind::cell, 0};
    session.current.look.field.fog = {{-1, 0.5}, {0, 1}};
    session.current.ongoingTurnToward = session::OngoingTurnToward{{}, 1};
    ObjectTable table;
    const json whole = json::from_cbor(encodeWhole(session, 10, table.keyOf));
    const auto refusalOf = [&](const json& record, const std::string& head = "") -> std::string {
        try {
            decodeSession(encodeCbor(record), head, table.objectOf, support::cache());
        } catch (const UnreadableRecord& fault) {
            return fault.what();
        }
        return "";
    };
    ASSERT_EQ(refusalOf(whole), "");
    // The record; its state; the angles, the slices, the look, the turn toward an element and the frame of reference;
    // the parts, the camera's orbit, the highlight, the settings of the field and a control point of its fog; and a
    // state of the history.
    for (const char* place : {"", "/3", "/3/3", "/3/4", "/3/5", "/3/8", "/3/9", "/3/5/1", "/3/5/2", "/3/5/8", "/3/5/10",
                              "/3/5/10/2/0", "/4/0"}) {
        json later = whole;
        json& array = later.at(json::json_pointer(place));
        ASSERT_TRUE(array.is_array()) << place;
        array.push_back(false);
        EXPECT_NE(refusalOf(later).find("a later version"), std::string::npos) << place << ": " << refusalOf(later);
    }
    ++session.revision;
    json head = json::from_cbor(encodeHead(session, table.keyOf));
    ASSERT_EQ(refusalOf(whole, encodeCbor(head)), "");
    head.push_back(false);
    EXPECT_NE(refusalOf(whole, encodeCbor(head)).find("a later version"), std::string::npos);
}

TEST(Codec, MakesTheImageOfAnObjectOnce) {
    Session session;
    for (const char* text : {"polytope 24-cell", "boost x 0.6", "set spacing=0.1", "focus 3", "boost x 0.5", "focus 4"})
        session::line(session, text);
    ObjectTable table;
    const Session back = decodeSession(encodeWhole(session, 10, table.keyOf), "", table.objectOf, support::cache());
    ASSERT_TRUE(same(session, back));
    ASSERT_EQ(back.undoSteps.size(), 6U);
    EXPECT_EQ(back.undoSteps[2].object, back.undoSteps[4].object);
    EXPECT_EQ(back.undoSteps[5].object, back.current.object);
    EXPECT_NE(back.undoSteps[4].object, back.undoSteps[5].object);
    EXPECT_EQ(back.current.source, session.current.source) << "the object itself comes from the catalogue";
    EXPECT_EQ(session::ownObjectMemory(back), session::ownObjectMemory(session));
}

TEST(Codec, BuildsComposedPolytopesFromTheirNames) {
    Session session;
    for (const char* text :
         {"polytope pyramid of dual of cuboctahedron",
          "polytope hull of truncation of omnitruncated 5-cell of circumradius 2.5 and intersection of "
          "runcitruncated tesseract and rectification of 5,7-duoprism",
          "polytope dual of bipyramid of 7-gonal antiprism"})
        session::line(session, text);
    ObjectTable table;
    polytopes::PolytopeCache cache;  // which has none of them
    const Session back = decodeSession(encodeWhole(session, 10, table.keyOf), "", table.objectOf, cache);
    EXPECT_EQ(table.size(), 0U) << "their names suffice";
    ASSERT_EQ(back.undoSteps.size(), session.undoSteps.size());
    const auto expectSame = [](const slicing::Object& one, const slicing::Object& other) {
        EXPECT_EQ(slicing::infoOf(one).name, slicing::infoOf(other).name);
        EXPECT_EQ(slicing::elementCounts(one), slicing::elementCounts(other));
    };
    expectSame(back.current.object, session.current.object);
    for (std::size_t i = 0; i < back.undoSteps.size(); ++i)
        expectSame(back.undoSteps[i].object, session.undoSteps[i].object);
}

TEST(Codec, KeepsTheFogOfAField) {
    Session session;
    for (const char* text : {"formula x^2+y^2 < w", "fog -1:0.5,0:1:ff8000,2:0"}) session::line(session, text);
    ObjectTable table;
    const auto decoded = [&](const std::string& bytes) {
        return decodeSession(bytes, "", table.objectOf, support::cache());
    };
    const std::string bytes = encodeWhole(session, 10, table.keyOf);
    EXPECT_EQ(decoded(bytes).current.look, session.current.look);
    EXPECT_TRUE(decoded(bytes).undoSteps.back().look.field.fog.empty());
    auto record = nlohmann::json::from_cbor(bytes);
    nlohmann::json& field = record.at(3).at(5).at(10);
    nlohmann::json& fog = field.at(2);
    const nlohmann::json points = fog;
    for (const nlohmann::json& bad : {nlohmann::json::array({points[0]}),
                                      {points[1], points[0]},
                                      {{0, 2, 0}, {1, 0, 0}},
                                      {{0, 1, 1 << 24U}, {1, 0, 0}},
                                      {{0, 1}, {1, 0}},
                                      {{0, "1", 0}, {1, 0, 0}}}) {
        fog = bad;
        EXPECT_THROW(decoded(encodeCbor(record)), UnreadableRecord) << bad;
    }
    field.erase(2);
    EXPECT_TRUE(decoded(encodeCbor(record)).current.look.field.fog.empty()) << "earlier versions knew no fog";
}

TEST(Codec, KeepsTheBackground) {
    Session session;
    session::line(session, "set background=white");
    session::line(session, "set background=transparent");
    ObjectTable table;
    const auto decoded = [&](const std::string& bytes) {
        return decodeSession(bytes, "", table.objectOf, support::cache());
    };
    const std::string bytes = encodeWhole(session, 10, table.keyOf);
    EXPECT_EQ(decoded(bytes).current.look.background, scene::Background::transparent);
    EXPECT_EQ(decoded(bytes).undoSteps.back().look.background, scene::Background::white);
    auto record = nlohmann::json::from_cbor(bytes);
    nlohmann::json& look = record.at(3).at(5);
    look.at(12) = scene::kBackgrounds.size();
    EXPECT_THROW(decoded(encodeCbor(record)), UnreadableRecord) << "no background has this number";
    while (look.size() > 12) look.erase(12);
    EXPECT_EQ(decoded(encodeCbor(record)).current.look.background, scene::Background::automatic)
        << "earlier versions knew only one";
}

TEST(Codec, LimitsUndoSteps) {
    std::mt19937 random(6);
    Session session;
    applyRandomCommands(session, random, 200);
    ObjectTable table;
    const Session back = decodeSession(encodeWhole(session, 7, table.keyOf), "", table.objectOf, support::cache());
    ASSERT_EQ(back.undoSteps.size(), 7U);
    session.undoSteps.erase(session.undoSteps.begin(), session.undoSteps.end() - 7);
    EXPECT_TRUE(same(session, back));
}

TEST(Codec, RefusesOtherVersionsAndOtherData) {
    const ObjectLookup none = [](const std::string&) { return std::nullopt; };
    ObjectTable table;
    std::string bytes = encodeWhole(Session{}, 10, table.keyOf);
    ASSERT_EQ(bytes[1], 1) << "the version";
    bytes[1] = 2;
    try {
        decodeSession(bytes, "", none, support::cache());
        FAIL() << "a later version was read";
    } catch (const UnreadableRecord& fault) {
        EXPECT_NE(std::string(fault.what()).find("version 2"), std::string::npos) << fault.what();
    }
    for (const std::string other : {"", "x", "\x80", "\xa0", "\x81\x01", "{\"a\":1}"}) {
        EXPECT_THROW(decodeSession(other, "", none, support::cache()), UnreadableRecord) << other;
        EXPECT_THROW(decodeObjectRecord(other), UnreadableRecord) << other;
    }
}

/// The records are well-formed, but no session can have these values.
TEST(Codec, RefusesInvalidValues) {
    const ObjectLookup none = [](const std::string&) { return std::nullopt; };
    ObjectTable table;
    Session session;
    const auto refused = [&](auto change) {
        Session other = session;
        change(other.current);
        EXPECT_THROW(decodeSession(encodeWhole(other, 10, table.keyOf), "", table.objectOf, support::cache()),
                     UnreadableRecord);
    };
    ASSERT_NO_THROW(decodeSession(encodeWhole(session, 10, table.keyOf), "", none, support::cache()));
    using session::State;
    refused([](State& state) { state.step = 0; });
    refused([](State& state) { state.alpha = 7; });
    refused([](State& state) { state.slices.count = 4; });
    refused([](State& state) { state.slices.focus = std::numeric_limits<int>::min(); });
    refused([](State& state) { state.slices.spacing = 1e9; });
    refused([](State& state) { state.slices.spacing = 1e-9; });
    refused([](State& state) { state.look.orbit.zoom = 0; });
    refused([](State& state) { state.look.orbit.azimuth = 1e9; });
    refused([](State& state) { state.look.thickness = 5; });
    refused([](State& state) { state.look.opacity = 0.2; });
    refused([](State& state) { state.turning = true; });
    refused([](State& state) { state.lastTurn = geometry::Turn{geometry::Plane::xy, 1e7, {}}; });
    refused([](State& state) { state.look.cellTypes = {{0}, {0}}; });
    refused([](State& state) { state.referenceFrame.pace = 0; });
    refused([](State& state) { state.referenceFrame.follow.y = 1e4; });
    refused([](State& state) { state.referenceFrame.boost = glm::dvec3(0.7); });
    session.pendingKey = "\xff";
    refused([](State&) {});
    session.pendingKey.clear();
    session.revision = 1ULL << 54U;
    refused([](State&) {});
}

/// Declared sizes do not reserve memory, and deep nesting does not overflow the stack.
TEST(Codec, RefusesExcessiveSizesAndNesting) {
    const ObjectLookup none = [](const std::string&) { return std::nullopt; };
    const std::string huge("\xff\xff\xff\xff\xff\xff\xf0", 7);
    std::vector<std::string> inputs{std::string(3'000'000, '\x81'), std::string(3'000'000, '\x9f')};
    std::string maps;
    for (int i = 0; i < 1'000'000; ++i) maps += "\xa1\x60";
    inputs.push_back(maps);
    for (const char kind : {'\x5b', '\x7b', '\x9b', '\xbb'})  // bytes, text, an array, a map
        inputs.push_back(std::string("\x82\x01") + kind + '\0' + huge);
    // Many polytopes with names of the catalogue, each with almost a million vertices.
    std::string many("\x88\x01\x00\x98\x20", 5);
    for (int i = 0; i < 32; ++i)
        many += "\x81\x70" + std::to_string(1000 - i) + "," + std::to_string(900 + i) + "-duoprism";
    inputs.push_back(many + std::string("\x80\x80\x80\x80\x60", 5));
    for (const std::string& input : inputs) {
        EXPECT_THROW(decodeSession(input, "", none, support::cache()), UnreadableRecord);
        EXPECT_THROW(decodeObjectRecord(input), UnreadableRecord);
    }
}

/// An image in a frame of reference is not made before its size is checked. Each object that is made gets a serial
/// number, so no number is missing.
TEST(Codec, MakesNoImageBeyondTheLimitOfVertices) {
    const geometry::ReferenceFrame frame{.pace = 2}, other{.pace = 3};
    const auto list = nlohmann::json::array({nlohmann::json::array({"mesh", "key"})});
    geometry::JaggedArray faces;
    faces.add(std::array{0U, 1U, 2U});
    slicing::Object mesh = std::make_shared<const geometry::SurfaceMesh>(
        geometry::makeSurfaceMesh("mesh", {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}, std::move(faces)));
    const ObjectLookup lookup = [&](const std::string&) { return mesh; };
    const std::size_t needed = slicing::memoryOf(mesh) / 100;
    ASSERT_GE(needed, 3U);
    ObjectListDecoder objects(list, lookup, support::cache(), needed);
    const slicing::Object image = objects.transformedTo(objects.at(0), frame);
    EXPECT_TRUE(objects.transformedTo(objects.at(0), frame) == image);
    const std::uint64_t before = geometry::nextSerial();
    EXPECT_THROW(objects.transformedTo(objects.at(0), other), UnreadableRecord);
    EXPECT_EQ(geometry::nextSerial(), before + 1);
}

/// Damaged bytes decode to a session that can be sliced, or throw UnreadableRecord.
TEST(Codec, SurvivesDamage) {
    std::mt19937 random(7);
    Session session;
    applyRandomCommands(session, random, 30);
    ASSERT_TRUE(session::apply(session, ownObject("own", 1)));
    ObjectTable table;
    const std::string whole = encodeWhole(session, 100, table.keyOf);
    const std::string object = encodeObjectRecord(session.loaded.at("own"));
    int unreadable = 0;
    for (int round = 0; round < 3000; ++round) {
        std::string damaged = round % 2 == 0 ? whole : object;
        for (unsigned i = 0; i < 1 + random() % 3; ++i)
            damaged[random() % damaged.size()] = static_cast<char>(random());
        if (random() % 4 == 0) damaged.resize(random() % damaged.size());
        try {
            if (round % 2 == 1) {
                decodeObjectRecord(damaged);
            } else {
                const Session read = decodeSession(damaged, "", table.objectOf, support::cache());
                EXPECT_GT(read.current.hyperplanes().count, 0);
                for (const std::uint32_t kind : read.current.look.cellTypes.hidden)
                    EXPECT_LT(kind, slicing::infoOf(read.current.object).cellTypes.size());
            }
        } catch (const UnreadableRecord&) {
            ++unreadable;
        }
    }
    EXPECT_GT(unreadable, 1000);
}

TEST(Codec, BringsSurfacesBack) {
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

TEST(Codec, RefusesInvalidSurfaces) {
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

TEST(Codec, FieldsKeepTheirSecondFunction) {
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

// A field of an array with units, and with a second array if it `hasSecond`.
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

TEST(Codec, FieldsKeepTheirUnits) {
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

TEST(Codec, FieldsWithoutUnitsAreStoredAsBefore) {
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

TEST(Codec, RefusesInvalidUnits) {
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

// --- What the server accepts can be read

// Returns the session after it was stored and read again.
Session readAgain(const Session& session) {
    ObjectTable table;
    return decodeSession(encodeWhole(session, 1000, table.keyOf), "", table.objectOf, support::cache());
}

// Makes a field of an array.
slicing::Object fieldOf(const fields::Shape& shape, const fields::Box& box, const std::vector<float>& samples) {
    fields::FieldArray array;
    array.shape = shape;
    array.box = box;
    array.samples = fields::SampleStorage(std::vector<float>(samples));
    return std::make_shared<const fields::Field>(*fields::fieldFromArray("array", array));
}

TEST(Codec, ReadsBoxesOfAnySizeThatFieldsMayHave) {
    for (const double size : {1e16, 1e30}) {
        const fields::Box box{glm::dvec4(-size), glm::dvec4(size)};
        Session session;
        session::LoadObject load{"wide", "formula", "x+y+z+w"};
        load.box = box;
        session::must(session, load);
        EXPECT_TRUE(same(session, readAgain(session))) << size;
        const std::string record = encodeObjectRecord(fieldOf({2, 2, 2, 2}, box, std::vector<float>(16)));
        EXPECT_EQ(encodeObjectRecord(decodeObjectRecord(record)), record) << size;
    }
    EXPECT_THROW(decodeObjectRecord(
                     encodeCbor({kRecordVersion, "a", "x", nlohmann::json::parse("[[-1e31,-1,-1,-1],[1e31,1,1,1]]"),
                                 nlohmann::json::array()})),
                 UnreadableRecord);
}

TEST(Codec, ReadsFieldsWithSamplesBeyondAllLevels) {
    for (const float sample : {1e35F, -1e35F, 3e38F}) {
        Session session;
        session::ObjectLoader loader({}, support::cache());
        const fields::Box box{glm::dvec4(-1), glm::dvec4(1)};
        const auto field = fieldOf({2, 2, 2, 2}, box, std::vector<float>(16, sample));
        ASSERT_TRUE(session::replaceObject(session.current, field, loader));
        EXPECT_EQ(session.current.look.field.levels, std::vector{std::copysign(slicing::kMaxLevel, double{sample})});
        EXPECT_TRUE(same(session, readAgain(session))) << sample;
    }
}

// The second time step changes the proportions of the domain, and with them the bounds of the settings.
TEST(Codec, ReadsSessionsWhoseFieldHasGrown) {
    struct Array {
        std::size_t samples;  // along x, y and z
        glm::dvec4 max;       // of its box
    };
    for (const auto& [samples, max] : {Array{2, {1, 1, 1, 0}}, Array{1, {0, 0, 0, 100}}}) {
        const session::FileReader reader = [&](const session::LoadObject&, const session::Limits&) {
            const fields::Shape shape{samples, samples, samples, 1};
            const std::vector<float> values(samples * samples * samples, 1.F);
            return Result<session::ObjectWithWarnings>({fieldOf(shape, {glm::dvec4(0), max}, values), {}});
        };
        for (const bool alongW : {false, true}) {
            Session session;
            session::LoadObject load{"run", "npy", ""};
            const auto execute = [&] {
                session::ObjectLoader loader({}, support::cache(), session::ObjectLoader::Mode::deferred, reader);
                Result<std::monostate> done = std::monostate{};
                session::ordersOf(session, load, loader, done);
                EXPECT_TRUE(done);
            };
            execute();
            const double radius = slicing::infoOf(session.current.object).circumradius;
            session::Set set;
            set.spacing = 9 * radius;
            if (alongW) set.offset = -9 * radius;
            set.focusPoint = glm::dvec4(9, -9, 9, -9) * radius;
            if (slicing::infoOf(session.current.object).cellTypes.size() > 1) set.hidden = {{1}};
            session::must(session, set);
            load.append = true;
            execute();
            const session::State& state = session.current;
            const double grown = slicing::infoOf(state.object).circumradius;
            EXPECT_NE(grown, radius);
            EXPECT_LE(state.slices.spacing, session::kMaxSpacing * grown);
            EXPECT_LE(std::abs(state.slices.offset), session::kMaxOffset * grown);
            EXPECT_LE(std::abs(state.look.focusPoint.y), session::kMaxOffset * grown);
            EXPECT_TRUE(same(session, readAgain(session))) << samples;
        }
    }
}

TEST(Codec, ReadsTheFocusPointAtItsBoundsFarFromTheOrigin) {
    Session session;
    constexpr double kFar = 99'999'999'999'990;
    session::must(session, session::LoadObject{"far", "cloud",
                                               "99999999999990 1.001 0 0\n"
                                               "99999999999990 -1.001 0 0\n"});
    const geometry::ObjectInfo& info = slicing::infoOf(session.current.object);
    ASSERT_EQ(info.originInFile, glm::dvec4(kFar, 0, 0, 0));
    const double reach = session::kMaxOffset * info.circumradius;
    ASSERT_GT(kFar + reach - kFar, reach * (1 + 1e-6)) << "the sum is rounded up";
    session::Set set;
    set.focusPoint = glm::dvec4(kFar + reach, 0, 0, 0);
    session::must(session, set);
    EXPECT_EQ(session.current.look.focusPoint.x, reach);
    EXPECT_TRUE(same(session, readAgain(session)));
}

TEST(Codec, ReadsALargeFieldInManyFramesOfReference) {
    constexpr std::size_t kSide = 32, kFrames = 300;
    const std::vector<float> samples(kSide * kSide * kSide * kSide, 1.F);
    const auto field = fieldOf({kSide, kSide, kSide, kSide}, {glm::dvec4(-1), glm::dvec4(1)}, samples);
    ASSERT_GT(kFrames * slicing::memoryOf(field), std::size_t{1'000'000'000}) << "the limit, if each counted in full";
    Session session;
    session::ObjectLoader loader({}, support::cache());
    ASSERT_TRUE(session::replaceObject(session.current, field, loader));
    for (std::size_t i = 1; i <= kFrames; ++i) session::line(session, "set pace=" + std::to_string(1 + 0.01 * i));
    EXPECT_EQ(readAgain(session).undoSteps.size(), session.undoSteps.size());
}

}  // namespace
}  // namespace oval4d::store
