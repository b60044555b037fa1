#include <array>
#include <cstdint>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "fields/array_field.hpp"
#include "image/png.hpp"
#include "polytopes/catalogue/catalogue.hpp"
#include "protocol_data/embedded_files.hpp"
#include "session/example_fields.hpp"
#include "session/load.hpp"
#include "session/session.hpp"
#include "session/settings.hpp"
#include "unit/session/setting_values.hpp"
#include "unit/wire/support.hpp"
#include "wire/messages.hpp"
#include "wire/state_message.hpp"

namespace oval4d::wire {
namespace {

using nlohmann::json;
using session::Session;
using session::State;

Session randomSession(unsigned seed) {
    std::mt19937 random(seed);
    const std::string keys = "234567rtyRTYkjKJlh[]{}nNopfbe";
    Session session;
    for (int i = 0; i < 100; ++i) {
        const session::KeyPress key{
            std::string(1, keys[std::uniform_int_distribution<std::size_t>(0, keys.size() - 1)(random)])};
        EXPECT_TRUE(apply(session, key));
    }
    EXPECT_TRUE(apply(session, session::CommandLine{"set azimuth=0.1 elevation=-0.2 zoom=1.5 step=0.01"}));
    const std::array looks{"color cell", "color kind", "color w", "set color=plain hidden=0", "fade 0"};
    EXPECT_TRUE(apply(session, session::CommandLine{looks.at(seed % looks.size())}));
    if (seed % 3 == 0) {
        EXPECT_TRUE(apply(session, session::CommandLine{"set pace=2 follow=0.3,0,-0.1 boost=0,0.5,0"}));
    }
    if (seed % 2 == 0) {
        EXPECT_TRUE(apply(session, session::KeyPress{" "}));
    }
    return session;
}

void expectSame(const State& a, const State& b) {
    const glm::dmat4 m = a.orientation.matrix();
    const glm::dmat4 n = b.orientation.matrix();
    for (int c = 0; c < 4; ++c) {
        for (int r = 0; r < 4; ++r) EXPECT_NEAR(m[c][r], n[c][r], 1e-14);
    }
    State likeA = b;
    likeA.orientation = a.orientation;
    likeA.object = a.object;  // the same object in the same frame of reference
    EXPECT_EQ(likeA, a) << "all but the orientation's last bits";
}

TEST(StateMessage, FitsItsSchemaAndSaysEverything) {
    Session session;
    ASSERT_TRUE(apply(session, session::CommandLine{"rotate xw,yz pi/8 0.2"}));
    const json message = fitting(wire::stateMessage(session.current, {}, 7, 3));
    EXPECT_EQ(message.at("type"), "state");
    EXPECT_EQ(message.at("id"), 3);
    EXPECT_EQ(message.at("revision"), 7);
    json polytope = json::parse(R"({"name":"5-cell","vertices":5,"edges":10,"faces":10,"cells":5,
                              "kinds":[{"name":"tetrahedron","cells":5}]})");
    polytope["kinds"][0]["color"] = scene::cellTypeColor(0, 1);
    EXPECT_EQ(message.at("polytope"), polytope);
    EXPECT_EQ(message.at("pace"), 1);
    EXPECT_EQ(message.at("follow"), json::parse("[0,0,0]"));
    EXPECT_EQ(message.at("boost"), json::parse("[0,0,0]"));
    EXPECT_EQ(message.at("orientation").at(0).at(3), session.current.orientation.matrix()[3][0]) << "rows";
    EXPECT_EQ(message.at("alpha"), std::numbers::pi / 36);
    EXPECT_EQ(message.at("step"), std::numbers::pi / 180);
    EXPECT_EQ(message.at("slices").at("count"), 21);
    EXPECT_EQ(message.at("slices").at("focus"), 0);
    EXPECT_EQ(message.at("view"), "oval");
    EXPECT_EQ(message.at("turning"), false);
    EXPECT_EQ(message.at("playing"), false);
    EXPECT_EQ(message.at("speed"), 1);
    EXPECT_EQ(message.at("shown"),
              json::parse(R"({"faces":true,"bars":true,"balls":true,"coordinates":true,"labels":true,
                                        "cells":false,"back":true,"sections":false})"));
    EXPECT_EQ(message.at("camera"), json::parse(R"({"azimuth":0,"elevation":0,"zoom":1})"));
    EXPECT_EQ(message.at("color"), "cell");
    EXPECT_EQ(message.at("background"), "auto");
    EXPECT_EQ(message.at("hidden"), json::array());
    EXPECT_EQ(message.at("faded"), json::array());
    EXPECT_EQ(message.at("last").at("planes"), json::parse(R"(["xw","yz"])"));
    EXPECT_EQ(message.at("last").at("angles").at(0), std::numbers::pi / 8);
    EXPECT_TRUE(fitting(wire::stateMessage(session::initialState(), {}, 0)).at("last").is_null());
    EXPECT_FALSE(fitting(wire::stateMessage(session::initialState(), {}, 0)).contains("id"));
    EXPECT_FALSE(fitting(wire::stateMessage(session::initialState(), {}, 0)).contains("draft"));
    EXPECT_EQ(fitting(wire::stateMessage(session::initialState(), {}, 0, {}, slicing::Quality::draft)).at("draft"),
              true);
}

TEST(StateMessage, HasTheSerialNumberOfTheSourceInSessionsOnly) {
    Session session;
    const auto serial = [&] { return fitting(wire::stateMessage(session.current, {}, 1)).at("object_serial"); };
    const json before = serial();
    EXPECT_EQ(before, slicing::infoOf(session.current.source).serial);
    EXPECT_LE(before.get<std::uint64_t>(), std::uint64_t{1} << 53U) << "as a 64-bit float";
    ASSERT_TRUE(apply(session, session::CommandLine{"set pace=2"}));
    EXPECT_NE(slicing::infoOf(session.current.object).serial, slicing::infoOf(session.current.source).serial);
    EXPECT_EQ(serial(), before) << "the frame of reference does not change the object";

    json message = fitting(wire::stateMessage(session.current, {}, 0));
    message.erase("object_serial");
    EXPECT_EQ(fitting(wire::stateMessageOutsideSessions(session.current, {})), message);
}

TEST(StateMessage, HasTheColorsThatTheViewerSees) {
    using scene::ColorScheme;
    Session session;
    const auto colorFor = [&](ColorScheme viewer) {
        const json message = fitting(wire::stateMessage(session.current, {}, 0, {}, slicing::Quality::full, viewer));
        return message.at("polytope").at("kinds").at(0).at("color");
    };
    const scene::Color onDark = scene::cellTypeColor(0, 1), onLight = scene::cellTypeColor(0, 1, ColorScheme::light);
    EXPECT_EQ(colorFor(ColorScheme::dark), onDark);
    EXPECT_EQ(colorFor(ColorScheme::light), onLight);
    session.current.look.background = scene::Background::dark;
    EXPECT_EQ(colorFor(ColorScheme::light), onDark);
    session.current.look.background = scene::Background::white;
    EXPECT_EQ(colorFor(ColorScheme::dark), onLight);
    EXPECT_EQ(fitting(wire::stateMessage(session.current, {}, 0)).at("background"), "white");
}

TEST(StateMessage, SetInANewSessionGivesTheSameState) {
    for (unsigned seed = 0; seed < 40; ++seed) {
        const Session session = randomSession(seed);
        const std::string text = wire::stateMessage(session.current, {}, session.revision, 1);
        fitting(text);
        const auto set = setCommandFromState(text);
        ASSERT_TRUE(set) << set.error().message;
        Session fresh;
        const auto done = apply(fresh, *set);
        ASSERT_TRUE(done) << done.error().message;
        expectSame(fresh.current, session.current);

        Session same = session;
        ASSERT_TRUE(apply(same, *set));
        EXPECT_TRUE(same == session) << "its own state changes nothing in a session";
    }
}

TEST(StateMessage, LosesNoSetting) {
    for (const session::SettingValue& setting : session::settingValues()) {
        const auto set = setCommandFromState(wire::stateMessage(sessionWith(setting).current, {}, 1));
        ASSERT_TRUE(set) << setting.name << ": " << set.error().message;
        Session fresh;
        ASSERT_TRUE(apply(fresh, *set)) << setting.name;
        EXPECT_TRUE(setting.isIn(fresh.current)) << setting.name;
    }
}

TEST(StateMessage, RestoresAFormulaInANewSession) {
    Session session;
    session::LoadObject load{"mine", "formula", "x^2 + y^2 + a*z^2 + w^2; a=0.5"};
    load.box = fields::Box{glm::dvec4(-1), glm::dvec4(1, 1, 1, 2)};
    load.secondFormula = "x*y";
    ASSERT_TRUE(apply(session, load));
    session::ChangeSettings look;
    look.levels = std::vector<double>{0.25, 0.5};
    look.pace = 2;
    ASSERT_TRUE(apply(session, look));
    const auto set = setCommandFromState(wire::stateMessage(session.current, {}, session.revision));
    ASSERT_TRUE(set) << set.error().message;
    Session fresh;
    const auto done = apply(fresh, *set);
    ASSERT_TRUE(done) << done.error().message;
    const fields::Field *before = slicing::fieldIn(session.current.object),
                        *after = slicing::fieldIn(fresh.current.object);
    ASSERT_NE(after, nullptr);
    EXPECT_EQ(after->formula, before->formula);
    EXPECT_EQ(after->box, before->box);
    EXPECT_EQ(after->second->formula, "x*y");
    EXPECT_EQ(fresh.current.look.field, session.current.look.field);
    EXPECT_EQ(fresh.current.slices, session.current.slices);
    EXPECT_EQ(fresh.current.referenceFrame, session.current.referenceFrame);
}

// Returns a field of an array with units, and with a second array.
fields::Field fieldWithUnits() {
    fields::FieldArray array;
    array.shape = {2, 1, 1, 1};
    array.box = {glm::dvec4(-1), glm::dvec4(1)};
    array.samples = fields::SampleStorage(std::vector<float>{1, 2});
    array.units = {"m", "", "", "s \"UTC\""};
    array.quantity = {"temperature", "K"};
    fields::Field field = *fields::fieldFromArray("run", array);
    array.quantity = {"", "Pa"};
    EXPECT_FALSE(fields::setSecondArray(field, array, "p"));
    return field;
}

TEST(StateMessage, HasTheUnitsOfFields) {
    Session session;
    session::ObjectLoader loader({}, support::cache());
    fields::Field field = fieldWithUnits();
    const auto fieldIn = [&](const fields::Field& shown) {
        EXPECT_TRUE(session::replaceObject(session.current, std::make_shared<const fields::Field>(shown), loader));
        return fitting(wire::stateMessage(session.current, {}, 1)).at("field");
    };
    const json units = json::parse(R"({"x":"m","w":"s \"UTC\""})");
    session.current.referenceFrame.pace = 2;
    const json message = fieldIn(field);
    EXPECT_EQ(message.at("units"), units) << "of the box, in each frame of reference";
    EXPECT_EQ(message.at("quantity"), json::parse(R"({"name":"temperature","unit":"K"})"));
    EXPECT_EQ(message.at("values").at("quantity"), json::parse(R"({"unit":"Pa"})"));
    ASSERT_TRUE(setCommandFromState(wire::stateMessage(session.current, {}, 1)));
    field.units = {};
    field.quantity = {};
    field.second.reset();
    const json plain = fieldIn(field);
    EXPECT_FALSE(plain.contains("units"));
    EXPECT_FALSE(plain.contains("quantity"));
}

TEST(StateMessage, HasTheMomentOfTheFocusSlice) {
    Session session;
    session::ObjectLoader loader({}, support::cache());
    fields::FieldArray array;
    array.shape = {2, 2, 2, 2};
    array.box = {glm::dvec4(0), glm::dvec4(1, 1, 1, 200)};
    array.samples = fields::SampleStorage(std::vector<float>(16, 1));
    array.units = {"m", "", "", "s"};
    const auto field = std::make_shared<const fields::Field>(*fields::fieldFromArray("run", array));
    ASSERT_TRUE(session::replaceObject(session.current, field, loader));
    const auto section = [&] { return fitting(wire::stateMessage(session.current, {}, 1)).at("section"); };
    session.current.slices.offset = 0.25;
    const json coordinate = section().at("coordinate");
    EXPECT_EQ(coordinate.at("axis"), "w");
    EXPECT_NEAR(coordinate.at("value").get<double>(), 150, 1e-9);
    EXPECT_EQ(coordinate.at("unit"), "s");
    EXPECT_TRUE(setCommandFromState(wire::stateMessage(session.current, {}, 1)));
    session.current.orientation = geometry::Rotation(geometry::RotationAngles{geometry::Plane::xw, 0.3});
    EXPECT_FALSE(section().contains("coordinate")) << "the slice is not a moment";
    const Session ofPolytope;
    EXPECT_FALSE(fitting(wire::stateMessage(ofPolytope.current, {}, 1)).at("section").contains("coordinate"));
}

TEST(StateMessage, HasTheRegionAndTheLevelOfAPart) {
    Session session;
    session::ObjectLoader loader({}, support::cache());
    fields::Field field = fieldWithUnits();
    field.imageLevel = {1, 3};
    const auto fieldIn = [&](const fields::Field& shown) {
        EXPECT_TRUE(session::replaceObject(session.current, std::make_shared<const fields::Field>(shown), loader));
        return fitting(wire::stateMessage(session.current, {}, 1)).at("field");
    };
    EXPECT_FALSE(fieldIn(field).contains("resolution")) << "no array in the data folder";
    fields::FieldFileSource source{"run.zarr", "", "", "", "", "", {}, {}};
    field.source = std::make_shared<const fields::FieldFileSource>(source);
    const json overview = fieldIn(field);
    EXPECT_EQ(overview.at("resolution"), json::parse(R"({"level":1,"levels":3})"));
    EXPECT_FALSE(overview.contains("region"));
    field.imageLevel = {2, 3, 1};
    EXPECT_EQ(fieldIn(field).at("resolution"), json::parse(R"({"level":2,"levels":3,"refining":true})"));
    source.region = fields::Box{{0, 1, 2, 3}, {4, 5, 6, 7}};
    field.source = std::make_shared<const fields::FieldFileSource>(source);
    field.imageLevel = {};
    const json part = fieldIn(field);
    EXPECT_EQ(part.at("region"), json::parse("[[0,4],[1,5],[2,6],[3,7]]"));
    EXPECT_FALSE(part.contains("resolution"));
    EXPECT_TRUE(setCommandFromState(wire::stateMessage(session.current, {}, 1)));
}

TEST(StateMessage, IsFoundInFiles) {
    const std::string text = wire::stateMessage(randomSession(4).current, {}, 7);
    image::PngEncoder encoder;
    std::vector<std::uint8_t> file;
    encoder.encode(image::Image{1, 1, std::vector<std::uint8_t>(4)}, text, file);
    const std::string picture(file.begin(), file.end());
    for (const std::string& each : {text, " \n" + text, picture}) {
        EXPECT_TRUE(mayContainState(each));
        EXPECT_TRUE(setCommandFromFile(each));
    }
    for (const std::string_view other : {"", " ", "OFF", "4OFF\n{", "\x93NUMPY"}) EXPECT_FALSE(mayContainState(other));
    const auto none = setCommandFromFile(picture.substr(0, 33));
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().code, ErrorCode::bad_message);
    EXPECT_NE(none.error().message.find("contains no state"), std::string::npos);
}

TEST(StateMessage, BecomesASetByItsType) {
    const Session session = randomSession(3);
    json message = json::parse(wire::stateMessage(session.current, {}, session.revision));
    message["type"] = "set";
    Session fresh;
    ASSERT_TRUE(apply(fresh, parsedCommand<session::ChangeSettings>(message.dump())));
    expectSame(fresh.current, session.current);
}

TEST(StateMessage, WhatIsNoStateIsRefused) {
    const auto refused = [](std::string_view text, ErrorCode code, std::string_view says) {
        const auto set = setCommandFromState(text);
        ASSERT_FALSE(set) << text;
        EXPECT_EQ(set.error().code, code);
        EXPECT_NE(set.error().message.find(says), std::string::npos) << set.error().message;
    };
    refused("", ErrorCode::bad_json, "not JSON");
    refused("{", ErrorCode::bad_json, "not JSON");
    refused(R"({"alpha":0.1,"beta":,"type":"state"})", ErrorCode::bad_json, "at byte 21");
    refused("[]", ErrorCode::bad_message, "a message must be a JSON object");
    refused("{}", ErrorCode::bad_message, "\"type\":\"state\"");
    refused(R"({"type":"undo"})", ErrorCode::bad_message, "\"type\":\"state\"");
    refused(R"({"type":"state","alpha":"x"})", ErrorCode::bad_message, "/alpha must be an angle");
    refused(R"({"type":"state","slices":{"count":[[[[[[[[[[]]]]]]]]]]}})", ErrorCode::bad_json, "nests too deeply");
}

TEST(OtherMessages, FitTheirSchemas) {
    const json error = fitting(wire::errorMessage({ErrorCode::out_of_range, "a \"quoted\"\nword\x01 — ü"}, 12));
    EXPECT_EQ(error.at("code"), "out_of_range");
    EXPECT_EQ(error.at("message"), "a \"quoted\"\nword\x01 — ü");
    EXPECT_EQ(error.at("id"), 12);
    EXPECT_FALSE(fitting(wire::errorMessage({ErrorCode::internal, "x"}, {})).contains("id"));

    EXPECT_EQ(fitting(wire::answerMessage(wire::Done{8}, 0.5)),
              json::parse(R"({"type":"done","id":0.5,"revision":8})"));

    EXPECT_EQ(fitting(wire::answerMessage(wire::Measured{3, {}, {}, 8.0, glm::dvec4(0, 0, 0, -1), 0}, 5)),
              json::parse(R"({"type":"measured","id":5,"revision":3,"volume":8,"center":[0,0,0,-1],"kind":0})"));
    EXPECT_EQ(fitting(wire::answerMessage(wire::Measured{0, 2.0, {}, {}, glm::dvec4(1, 2, 3, 4), {}, "m"}, {})),
              json::parse(R"({"type":"measured","revision":0,"length":2,"center":[1,2,3,4],"unit":"m"})"));
    EXPECT_EQ(
        fitting(wire::answerMessage(wire::Measured{0, {}, 4.0, {}, glm::dvec4(1, 2, 3, 4), {}, {}, "square"}, {})),
        json::parse(R"({"type":"measured","revision":0,"area":4,"center":[1,2,3,4],"name":"square"})"));
    EXPECT_EQ(fitting(wire::answerMessage(wire::Measured{0, {}, {}, {}, glm::dvec4(1, 2, 3, 4)}, {})),
              json::parse(R"({"type":"measured","revision":0,"center":[1,2,3,4]})"));
    wire::Measured withHighlight{2, 2.0, {}, {}, glm::dvec4(1, 2, 3, 4)};
    withHighlight.highlight = slicing::PartsShowingElement{{17}, {41}, {8, 12}};
    withHighlight.range = glm::dvec2(-1, 0.5);
    EXPECT_EQ(fitting(wire::answerMessage(withHighlight, 6)),
              json::parse(R"({"type":"measured","id":6,"revision":2,"length":2,"center":[1,2,3,4],)"
                          R"("highlight":{"vertices":[17],"edges":[41],"own_vertices":[8,12]},"range":[-1,0.5]})"));

    const json described = readSchema("welcome.schema.json").at("properties").at("limits");
    json limits;
    for (const json& name : described.at("required")) limits[name.get<std::string>()] = 1;
    limits["shown_timeout"] = 1.5;
    const json welcome = fitting(wire::welcomeMessage("k3v", "secret", limits.dump(), 1));
    EXPECT_EQ(welcome.at("session"), "k3v");
    EXPECT_EQ(welcome.at("token"), "secret");
    EXPECT_EQ(welcome.at("protocol"), 1);
    EXPECT_EQ(welcome.at("server").get<std::string>().substr(0, 7), "oval4d ");
    EXPECT_EQ(welcome.at("limits").at("shown_timeout"), 1.5);

    const json keymap = fitting(wire::keymapMessage(4));
    EXPECT_EQ(keymap.at("id"), 4);
    EXPECT_EQ(keymap.at("keys"), json::parse(protocol_data::embeddedFile("keymap.json")).at("keys"));
    fitting(wire::keymapMessage({}));
}

TEST(OtherMessages, HaveTheDescribedMembersThatAreNotEmpty) {
    EXPECT_EQ(wire::answerMessage(wire::Done{8, {}}, {}), R"({"type":"done","revision":8})");
    EXPECT_EQ(wire::answerMessage(wire::Done{8, {"one", "two"}}, 3),
              R"({"type":"done","id":3,"revision":8,"warnings":["one","two"]})");
    EXPECT_EQ(wire::answerMessage(wire::Pong{2, 0, 1.25, 86400.5}, 14),
              R"({"type":"pong","id":14,"workers":2,"waiting":0,"busy":1.25,"time":86400.5})");
    EXPECT_EQ(wire::answerMessage(session::ShowLinkedView{"polytope=24-cell"}, 1),
              R"({"type":"address","id":1,"query":"polytope=24-cell"})");
}

TEST(OtherMessages, GiveIdsBackAsTheyWere) {
    const std::string_view ids[] = {
        "0",       "1", "1000000", "100000", "123456789012", "-7", "1.5", "9007199254740992", "-9007199254740992",
        "-1000000"};
    for (const std::string_view text : ids) {
        const auto id = parsed(R"({"type":"undo","id":)" + std::string(text) + '}').id;
        const std::string member = R"("id":)" + std::string(text) + ',';
        EXPECT_NE(wire::answerMessage(wire::Done{1}, id).find(member), std::string::npos)
            << wire::answerMessage(wire::Done{1}, id);
        EXPECT_NE(wire::errorMessage({ErrorCode::internal, "x"}, id).find(member), std::string::npos) << text;
        EXPECT_NE(wire::stateMessage(Session{}.current, {}, 1, id).find(member), std::string::npos) << text;
        EXPECT_NE(wire::catalogueMessage(id).find(member), std::string::npos) << text;
        EXPECT_NE(wire::keymapMessage(id).find(member), std::string::npos) << text;
        EXPECT_NE(wire::welcomeMessage("s", "t", "{}", id).find(member), std::string::npos) << text;
    }
}

TEST(StateMessage, WritesIntegersWithoutExponent) {
    session::State state = Session{}.current;
    state.alpha = -3'000'000;
    state.slices.spacing = 100'000;
    const std::string message = wire::stateMessage(state, {}, 1, {});
    EXPECT_NE(message.find(R"("alpha":-3000000,)"), std::string::npos) << message;
    EXPECT_NE(message.find(R"("spacing":100000,)"), std::string::npos) << message;
}

TEST(OtherMessages, TheCatalogueIsTheGeometrysAndTheExamples) {
    const json catalogue = fitting(wire::catalogueMessage(2)).at("polytopes");
    const std::size_t polytopes = polytopes::catalogue().size(), examples = session::exampleFields().size();
    ASSERT_EQ(catalogue.size(), polytopes + examples);
    for (std::size_t i = 0; i < examples; ++i) {
        EXPECT_EQ(catalogue[polytopes + i].at("name"), session::exampleFields()[i].name);
        EXPECT_EQ(catalogue[polytopes + i].at("family"), "fields");
    }
    for (std::size_t i = 0; i < polytopes; ++i) {
        const polytopes::Polytope& polytope = *support::shared(polytopes::catalogue()[i].name);
        EXPECT_EQ(catalogue[i].at("name"), polytope.name);
        EXPECT_EQ(catalogue[i].at("vertices"), polytope.vertices.size());
        EXPECT_EQ(catalogue[i].at("edges"), polytope.edges.size());
        EXPECT_EQ(catalogue[i].at("faces"), polytope.faces.size());
        EXPECT_EQ(catalogue[i].at("cells"), polytope.cells.size());
        EXPECT_EQ(catalogue[i].at("family"), polytopes::catalogue()[i].family);
        EXPECT_EQ(catalogue[i].at("diagram"), polytopes::catalogue()[i].diagram);
        for (const auto& alias : catalogue[i].at("aliases")) {
            EXPECT_EQ(polytopes::findEntry(alias.get<std::string>()), &polytopes::catalogue()[i]);
        }
    }
}

TEST(OtherMessages, TheCatalogueEndsWithWhatWasLoaded) {
    const std::vector<slicing::Object> loaded{Session{}.current.object};
    const json catalogue = fitting(wire::catalogueMessage({}, loaded)).at("polytopes");
    ASSERT_EQ(catalogue.size(), polytopes::catalogue().size() + session::exampleFields().size() + 1);
    EXPECT_EQ(catalogue.back(), json::parse(R"({"name":"5-cell","family":"loaded","aliases":[],"diagram":"",
                              "schlaefli":"","vertices":5,"edges":10,"faces":10,"cells":5})"));
}

}  // namespace
}  // namespace oval4d::wire
