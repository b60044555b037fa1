#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "geometry/surface_mesh.hpp"
#include "session/settings.hpp"
#include "store/cbor.hpp"
#include "store/object_list.hpp"
#include "unit/session/setting_values.hpp"
#include "unit/store/object_table.hpp"
#include "unit/store/support.hpp"

namespace oval4d::store {
namespace {

using session::Session;

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

// No member of a session is lost. The test notices the loss of a new member only if it gives the member another value
// than a new session has.
TEST(Codec, LosesNoMemberOfASession) {
    Session session;
    session::line(session, "polytope 24-cell");
    session::line(session, "polytope tesseract");
    ASSERT_TRUE(session::apply(session, ownObject("own", 1)));
    ASSERT_TRUE(session::apply(session, session::Undo{}));
    session.pendingKey = "g";
    ObjectTable table;
    const std::string bytes = encodeWhole(session, 10, table.keyOf);
    const auto record = nlohmann::json::from_cbor(bytes);
    const auto recordOfNew = nlohmann::json::from_cbor(encodeWhole(Session{}, 10, table.keyOf));
    ASSERT_EQ(record.size(), recordOfNew.size());
    for (std::size_t number = 1; number < record.size(); ++number)
        EXPECT_NE(record.at(number).dump(), recordOfNew.at(number).dump()) << number;
    const Session back = decodeSession(bytes, "", table.objectOf, support::cache());
    EXPECT_TRUE(same(session, back));
}

TEST(Codec, LosesNoSetting) {
    for (const session::SettingValue& setting : session::settingValues()) {
        const Session session = sessionWith(setting);
        ObjectTable table;
        const Session back = decodeSession(encodeWhole(session, 10, table.keyOf), "", table.objectOf, support::cache());
        EXPECT_TRUE(setting.isIn(back.current)) << setting.name;
    }
}

TEST(Codec, LosesNoMotion) {
    Session session;
    session::press(session, "2P");
    session.current.playsDownward = true;
    session.undoSteps.back().turning = true;  // allowed, because there is a last rotation
    session.current.ongoingTurnToward = session::OngoingTurnToward{geometry::Rotation(*session.current.lastTurn), 0.5};
    ObjectTable table;
    const Session back = decodeSession(encodeWhole(session, 10, table.keyOf), "", table.objectOf, support::cache());
    EXPECT_TRUE(back.current.playing && back.current.playsDownward && back.undoSteps.back().turning);
    EXPECT_EQ(back.current.lastTurn, session.current.lastTurn);
    EXPECT_EQ(back.current.ongoingTurnToward, session.current.ongoingTurnToward);
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
    nlohmann::json& look = record.at(3).at(5);  // the look of the current state
    nlohmann::json& flags = look.at(1);
    ASSERT_EQ(flags.size(), scene::kParts.size());
    const auto shorten = [](nlohmann::json& members, std::size_t size) {
        while (members.size() > size) members.erase(size);
    };
    shorten(flags, 4);               // version 0.1.0 knew only faces, bars, balls and coordinates
    shorten(look, 6);                // version 0.1.0 had no projection, no thickness and no opacity
    shorten(record.at(3).at(4), 3);  // version 0.1.0 had no offset
    shorten(record.at(3), 8);        // version 0.1.0 had no turn toward an element and no frame of reference
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

TEST(Codec, StoresEachPartUnderItsNumber) {
    for (const scene::NamedPicturePart& part : scene::kParts) {
        Session session;
        for (const scene::NamedPicturePart& each : scene::kParts) session.current.look.parts.*each.flag = false;
        session.current.look.parts.*part.flag = true;
        ObjectTable table;
        const std::string bytes = encodeWhole(session, 10, table.keyOf);
        const nlohmann::json flags = nlohmann::json::from_cbor(bytes).at(3).at(5).at(1);
        ASSERT_EQ(flags.size(), scene::kParts.size());
        for (std::size_t number = 0; number < flags.size(); ++number)
            EXPECT_EQ(flags.at(number).get<bool>(), number == part.number) << part.name;
        const Session back = decodeSession(bytes, "", table.objectOf, support::cache());
        EXPECT_EQ(back.current.look.parts, session.current.look.parts) << part.name;
    }
}

// A record with a member of a later version is refused. Otherwise, the member would be lost when the session is stored
// again.
TEST(Codec, RefusesMembersOfLaterVersions) {
    using nlohmann::json;
    Session session;
    ASSERT_TRUE(session::apply(session, ownObject("own", 1)));
    session::line(session, "set pace=2");
    session::press(session, "r");
    geometry::RotationAngles inThreePlanes(geometry::Plane::xy, 1, 1);
    inThreePlanes[geometry::Plane::xz] = 1;
    session.undoSteps.at(0).lastTurn = inThreePlanes;
    session.current.look.highlight = slicing::Element{slicing::ElementKind::cell, 0};
    session.current.look.field.fog = {{-1, 0.5}, {0, 1}};
    session.current.ongoingTurnToward = session::OngoingTurnToward{{}, 1};
    ObjectTable table;
    const json whole = json::from_cbor(encodeWhole(session, 10, table.keyOf));
    const auto refusalOf = [&](const json& record, const std::string& head = "") -> std::string {
        try {
            decodeSession(encodeCbor(record), head, table.objectOf, support::cache());
        } catch (const NewerVersionRecord& fault) {
            return fault.what();
        }
        return "";
    };
    ASSERT_EQ(refusalOf(whole), "");
    // These are all arrays that a later version may extend: the record; its state; the angles, the slices, the look,
    // the turn toward an element and the frame of reference; the visible parts, the camera's orbit, the highlight, the
    // settings of the field and a control point of its fog; and a state of the history. Some lists have a fixed length:
    // the name and the key of an object; a quaternion, a turn, a velocity and the focus point; a plane and its angle;
    // the name and the index of a loaded object.
    for (const char* place :
         {"",        "/3",          "/3/3", "/3/4", "/3/5", "/3/8", "/3/9",   "/3/5/1", "/3/5/2",   "/3/5/8",
          "/3/5/10", "/3/5/10/2/0", "/4/0", "/2/0", "/3/1", "/3/7", "/3/9/1", "/3/5/9", "/4/0/7/0", "/6/0"}) {
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
    EXPECT_EQ(session::unsharedMemoryOfObjects(back), session::unsharedMemoryOfObjects(session));
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
    polytopes::PolytopeCache cache;  // contains no polytope of the session
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
    } catch (const NewerVersionRecord& fault) {
        EXPECT_NE(std::string(fault.what()).find("version 2"), std::string::npos) << fault.what();
    }
    for (const std::string other : {"", "x", "\x80", "\xa0", "\x81\x01", "{\"a\":1}"}) {
        EXPECT_THROW(decodeSession(other, "", none, support::cache()), UnreadableRecord) << other;
        EXPECT_THROW(decodeObjectRecord(other), UnreadableRecord) << other;
    }
}

/// Records with values that no session can have are refused, even if they are well-formed.
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
    refused([](State& state) { state.playSpeed = 0; });
    refused([](State& state) { state.lastTurn = geometry::RotationAngles{geometry::Plane::xy, 1e7, {}}; });
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

/// Wrong sizes in a record do not reserve memory, and deep nesting does not overflow the stack.
TEST(Codec, RefusesExcessiveSizesAndNesting) {
    const ObjectLookup none = [](const std::string&) { return std::nullopt; };
    const std::string huge("\xff\xff\xff\xff\xff\xff\xf0", 7);
    std::vector<std::string> inputs{std::string(3'000'000, '\x81'), std::string(3'000'000, '\x9f')};
    std::string maps;
    for (int i = 0; i < 1'000'000; ++i) maps += "\xa1\x60";
    inputs.push_back(maps);
    for (const char kind : {'\x5b', '\x7b', '\x9b', '\xbb'})  // bytes, text, an array, a map
        inputs.push_back(std::string("\x82\x01") + kind + '\0' + huge);
    // Many polytopes with names that the catalogue knows. Each has almost a million vertices.
    std::string many("\x88\x01\x00\x98\x20", 5);
    for (int i = 0; i < 32; ++i)
        many += "\x81\x70" + std::to_string(1000 - i) + "," + std::to_string(900 + i) + "-duoprism";
    inputs.push_back(many + std::string("\x80\x80\x80\x80\x60", 5));
    for (const std::string& input : inputs) {
        EXPECT_THROW(decodeSession(input, "", none, support::cache()), UnreadableRecord);
        EXPECT_THROW(decodeObjectRecord(input), UnreadableRecord);
    }
}

/// The size of a transformed object is checked before the object is made. The test checks that no serial number was
/// taken, because each new object takes the next one.
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
    EXPECT_THROW(objects.transformedTo(objects.at(0), other), NewerVersionRecord);
    EXPECT_EQ(geometry::nextSerial(), before + 1);
}

/// Damaged records decode to a session that can be sliced, or throw UnreadableRecord.
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

}  // namespace
}  // namespace oval4d::store
