#include <cmath>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "scene/look.hpp"
#include "session/session.hpp"
#include "session/setting_text.hpp"
#include "text/message_text.hpp"
#include "unit/session/setting_values.hpp"
#include "unit/wire/support.hpp"
#include "wire/messages.hpp"

namespace oval4d::wire {
namespace {

TEST(Parse, Hello) {
    const auto hello = std::get<Hello>(
        parsed(
            R"({"type":"hello","id":1,"stream":"frames","encoding":"cbor","width":640,"height":480,"token":"abc","scheme":"light"})")
            .body);
    EXPECT_EQ(hello.stream, StreamKind::frames);
    EXPECT_EQ(hello.encoding, Encoding::cbor);
    EXPECT_EQ(hello.viewport, (scene::Viewport{640, 480}));
    EXPECT_EQ(hello.token, "abc");
    EXPECT_EQ(hello.scheme, scene::ColorScheme::light);
    const auto plain = std::get<Hello>(parsed(R"({"type":"hello","stream":"geometry"})").body);
    EXPECT_EQ(plain.stream, StreamKind::geometry);
    EXPECT_EQ(plain.encoding, Encoding::json);
    EXPECT_FALSE(plain.viewport);
    EXPECT_FALSE(plain.token);
    EXPECT_EQ(plain.scheme, scene::ColorScheme::dark);
    EXPECT_EQ(std::get<Hello>(parsed(R"({"type":"hello"})").body).stream, StreamKind::none);
}

TEST(Parse, Commands) {
    EXPECT_EQ(parsed(R"({"type":"undo","id":11.5})").id, 11.5);
    EXPECT_FALSE(parsed(R"({"type":"undo"})").id);
    const auto key = parsedCommand<session::KeyPress>(R"({"type":"key","key":"y","shift":true})");
    EXPECT_EQ(key.key, "y");
    EXPECT_TRUE(key.shift);
    EXPECT_FALSE(key.ctrl);
    const auto turn =
        parsedCommand<session::Rotate>(R"({"type":"rotate","planes":["yz","xw"],"angles":[1,-2.5]})").turn;
    EXPECT_EQ(turn, (geometry::RotationAngles{geometry::Plane::yz, 1, -2.5}));
    EXPECT_EQ(parsedCommand<session::Rotate>(R"({"type":"rotate","planes":["xy"],"angles":[0.5]})").turn,
              (geometry::RotationAngles{geometry::Plane::xy, 0.5, {}}));
    const auto toward = parsedCommand<session::TurnToward>(R"({"type":"toward","element":"edge","number":3})");
    EXPECT_EQ(toward.element, slicing::ElementKind::edge);
    EXPECT_EQ(toward.number, 3U);
    EXPECT_FALSE(toward.immediately);
    EXPECT_FALSE(parsedCommand<session::TurnToward>(R"({"type":"toward","element":"cell"})").number);
    EXPECT_EQ(parsedCommand<session::TurnAtRandom>(R"({"type":"random","seed":7})").seed, 7U);
    EXPECT_FALSE(parsedCommand<session::TurnAtRandom>(R"({"type":"random"})").seed);
    parsedCommand<session::Undo>(R"({"type":"undo"})");
    parsedCommand<session::Redo>(R"({"type":"redo"})");
    parsedCommand<session::ResetOrientationAndFocus>(R"({"type":"reset"})");
    EXPECT_EQ(parsedCommand<session::CommandLine>(R"({"type":"command","line":"polytope 600-cell"})").line,
              "polytope 600-cell");
    const auto load =
        parsedCommand<session::LoadObject>(R"({"type":"load","name":"mine","format":"off","data":"4OFF\n"})");
    EXPECT_EQ(load.name, "mine");
    EXPECT_EQ(load.format, "off");
    EXPECT_EQ(load.data, "4OFF\n");
}

TEST(Parse, GetAndShown) {
    const auto what = [](const std::string& name) {
        return std::get<Get>(parsed(R"({"type":"get","what":")" + name + "\"}").body).what;
    };
    EXPECT_EQ(what("state"), GetTarget::state);
    EXPECT_EQ(what("slices"), GetTarget::slices);
    EXPECT_EQ(what("frame"), GetTarget::frame);
    EXPECT_EQ(what("catalogue"), GetTarget::catalogue);
    EXPECT_EQ(what("keymap"), GetTarget::keymap);
    EXPECT_FALSE(std::get<Get>(parsed(R"({"type":"get","what":"frame"})").body).viewport);
    EXPECT_EQ(std::get<Get>(parsed(R"({"type":"get","what":"frame","width":64,"height":32})").body).viewport,
              (scene::Viewport{64, 32}));
    EXPECT_FALSE(std::get<Get>(parsed(R"({"type":"get","what":"frame"})").body).background);
    EXPECT_EQ(std::get<Get>(parsed(R"({"type":"get","what":"frame","background":"white"})").body).background,
              scene::Background::white);
    for (const std::string name : {"skeleton", "frame"}) {  // "frame" is the former name
        const std::string text = R"({"type":"get","what":"file","format":"stl","body":")" + name + "\"}";
        EXPECT_EQ(std::get<Get>(parsed(text).body).file.body, exports::BodyKind::skeleton);
    }
    const auto file = [](const std::string& members) {
        return std::get<Get>(parsed(R"({"type":"get","what":"file","format":"stl",)" + members + "}").body).file;
    };
    EXPECT_EQ(file(R"("at":[-1,0.5])").chosenW, (std::vector<double>{-1, 0.5}));
    EXPECT_EQ(file(R"("at":"-1, 1/2")").chosenW, (std::vector<double>{-1, 0.5}));
    EXPECT_EQ(file(R"("fit":5)").fittedSlices, 5);
    EXPECT_EQ(file(R"("fit":5)").contents, exports::ExportContentsKind::oval);
    EXPECT_TRUE(file(R"("exact":true)").exact);
    EXPECT_FALSE(file(R"("exact":false)").exact);
    EXPECT_FALSE(file(R"("fit":5)").exact);
    EXPECT_EQ(file(R"("at":[0],"of":"focus")").contents, exports::ExportContentsKind::focus);
    EXPECT_EQ(file(R"("body":"solid")").contents, exports::ExportContentsKind::focus);
    const auto measure = std::get<Measure>(parsed(R"({"type":"measure","element":"edge","number":17})").body);
    EXPECT_EQ(measure.element, slicing::ElementKind::edge);
    EXPECT_EQ(measure.number, 17U);
    EXPECT_FALSE(measure.highlight);
    EXPECT_TRUE(std::get<Measure>(parsed(R"({"type":"measure","element":"edge","number":17,"highlight":true})").body)
                    .highlight);
    EXPECT_TRUE(std::holds_alternative<Ping>(parsed(R"({"type":"ping"})").body));
    EXPECT_EQ(std::get<PictureShown>(parsed(R"({"type":"shown","revision":7})").body).revision, 7U);
}

TEST(Parse, SetsEverySetting) {
    nlohmann::json message{{"type", "set"}};
    session::ChangeSettings expected;
    std::set<std::string> tested;
    const auto add = [&](const std::string& place, const nlohmann::json& value) {
        message[nlohmann::json::json_pointer(place)] = value;
        tested.insert(place);
    };
    for (const session::SettingValue& setting : session::settingValues()) {
        add(setting.place, setting.message);
        EXPECT_TRUE(parseSetting(setting.name, setting.value, expected)) << setting.name;
    }
    add("/continues", true);
    add("/polytope", {{"name", "16-cell"}, {"cells", 16}});
    add("/field", nlohmann::json::parse(R"({"formula":"x*y","box":[[-1,1],[-1,1],[-1,1],[0,2]],
                                            "values":{"formula":"w","range":[0,2],"colors":[0,0,0,0,0,0,0,0,0]}})"));
    add("/orientation", nlohmann::json::parse("[[1,0,0,0],[0,0,-1,0],[0,1,0,0],[0,0,0,1]]"));
    add("/last", nlohmann::json::parse(R"({"planes":["xw"],"angles":[0.3]})"));

    const auto set = parsedCommand<session::ChangeSettings>(message.dump());
    EXPECT_EQ(settingTexts(set), settingTexts(expected)) << "the values that the command line sets";
    EXPECT_TRUE(set.continues);
    ASSERT_TRUE(set.formula);
    EXPECT_EQ(set.formula->name, "16-cell");
    EXPECT_EQ(set.formula->data, "x*y");
    EXPECT_EQ(set.formula->box->max, glm::dvec4(1, 1, 1, 2));
    EXPECT_EQ(set.formula->secondFormula, "w");
    ASSERT_TRUE(set.orientation);
    EXPECT_EQ(*set.orientation * glm::dvec4(0, 0, 1, 0), glm::dvec4(0, -1, 0, 0));
    EXPECT_EQ(set.lastTurn, (geometry::RotationAngles{geometry::Plane::xw, 0.3, {}}));

    // Expects that the list contains each setting of the schema.
    std::set<std::string> settings;
    const nlohmann::json properties = readSchema("set.schema.json").at("properties");
    for (const auto& [name, property] : properties.items()) {
        if (name == "type" || name == "id" || property.value("description", "").starts_with("Ignored")) continue;
        if (name != "slices" && name != "camera" && name != "shown") {
            settings.insert("/" + name);
            continue;
        }
        for (const auto& [member, schema] : property.at("properties").items())
            settings.insert("/" + name + "/" + member);
    }
    EXPECT_EQ(tested, settings);
    EXPECT_EQ(parsedCommand<session::ChangeSettings>(R"({"type":"set","polytope":"5-cell"})").object, "5-cell");
    EXPECT_EQ(parsedCommand<session::ChangeSettings>(R"({"type":"set","slices":{"count":21.0}})").count, 21)
        << "an integer, however it is written";
}

struct Bad {
    std::string text;
    ErrorCode code;
    std::string says;
    std::optional<double> id;
    bool notJson = false;
};

class BadMessages : public testing::TestWithParam<Bad> {};

TEST_P(BadMessages, GetTheirError) {
    const auto result = parseRequest(GetParam().text);
    const auto* bad = std::get_if<BadRequest>(&result);
    ASSERT_TRUE(bad) << GetParam().text;
    EXPECT_EQ(protocolName(bad->error.code), protocolName(GetParam().code)) << bad->error.message;
    EXPECT_NE(bad->error.message.find(GetParam().says), std::string::npos) << bad->error.message;
    EXPECT_EQ(bad->id, GetParam().id);
    EXPECT_EQ(bad->notJson, GetParam().notJson);
    EXPECT_FALSE(wire::errorMessage(bad->error, bad->id).empty());
}

/// Returns the names of all views in the form of the schema: "oval", "single" or "matrix".
std::string quotedViews() {
    std::vector<std::string> quoted;
    for (const scene::ViewTableRow& row : scene::kViews) quoted.push_back('"' + std::string(row.name) + '"');
    return text::joinedWithOr(std::vector<std::string_view>(quoted.begin(), quoted.end()));
}

constexpr auto kBadJson = ErrorCode::bad_json;
constexpr auto kBadMessage = ErrorCode::bad_message;
constexpr auto kUnknownType = ErrorCode::unknown_type;
constexpr auto kOutOfRange = ErrorCode::out_of_range;

INSTANTIATE_TEST_SUITE_P(
    NotJson, BadMessages,
    testing::Values(Bad{"", kBadJson, "unexpected end", {}, true}, Bad{"{", kBadJson, "unexpected end", {}, true},
                    Bad{"hello", kBadJson, "not JSON: unexpected 'h' at byte 1", {}, true},
                    Bad{R"({"type":"undo"} {})", kBadJson, "not JSON", {}, true},
                    Bad{"{'type':'undo'}", kBadJson, "not JSON", {}, true},
                    Bad{"{\"type\":\"key\",\"key\":\"\xff\"}", kBadJson, "not JSON", {}, true},
                    Bad{std::string("\0", 1), kBadJson, "not JSON", {}, true},
                    Bad{std::string(100, '['), kBadJson, "nests too deeply; at most 32 levels", {}, false},
                    Bad{std::string(1'000'000, '['), kBadJson, "nests too deeply", {}, false},
                    Bad{R"({"type":"undo","id":NaN})", kBadMessage, "undo: /id must be a number", {}, false}));

INSTANTIATE_TEST_SUITE_P(
    Numbers, BadMessages,
    testing::Values(
        Bad{R"({"type":"rotate","id":5,"planes":["xw"],"angles":[NaN]})", kBadMessage,
            "rotate: /angles/0 must be a finite number of radians", 5},
        Bad{R"({"type":"rotate","planes":["xw"],"angles":[NaN],"id":5})", kBadMessage, "NaN is not JSON (byte 44)", 5},
        Bad{R"({"type":"rotate","id":5,"planes":["xw","yz"],"angles":[Infinity,-Infinity]})", kBadMessage,
            "Infinity is not JSON", 5},
        Bad{R"({"type":"rotate","id":5,"planes":["xw","yz"],"angles":[0,-Infinity]})", kBadMessage,
            "/angles/1 must be a finite number of radians", 5},
        Bad{R"({"type":"rotate","id":5,"planes":["xw"],"angles":[1e999]})", kBadMessage,
            "1e999 is too large for a number", 5},
        Bad{R"({"type":"rotate","id":5,"planes":["xw"],"angles":[-1e999]})", kBadMessage, "-1e999 is too large", 5},
        Bad{R"({"type":"rotate","id":5,"planes":["xw"],"angles":[1e300]})", kOutOfRange,
            "/angles/0 must be a finite number", 5},
        Bad{R"({"type":"set","point":[NaN,NaN,NaN,-Infinity,1e999,NaN,NaN],"id":5})", kBadMessage,
            "NaN is not JSON (byte 24)", 5},
        Bad{R"({"type":"command","line":"NaN \" NaN","x":[NaN,1e-999],"id":5})", kBadMessage, "unknown member 'x'", 5},
        Bad{R"({"type":"rotate","planes":["xw"],"angles":[NaN,}],"id":5})", kBadJson, "NaN is not JSON", {}, true},
        Bad{R"({"type":"set","id":5,"last":NaN})", kBadJson, "NaN is not JSON", 5}));

INSTANTIATE_TEST_SUITE_P(
    Shapes, BadMessages,
    testing::Values(
        Bad{"[]", kBadMessage, "must be a JSON object", {}}, Bad{"7", kBadMessage, "must be a JSON object", {}},
        Bad{"null", kBadMessage, "must be a JSON object", {}},
        Bad{"{}", kBadMessage, "must have a member \"type\", one of hello, key", {}},
        Bad{R"({"type":7,"id":1})", kBadMessage, "must have a member \"type\"", 1},
        Bad{R"({"type":"rotat","id":1})", kUnknownType, "no message has the type 'rotat' (did you mean 'rotate'?)", 1},
        Bad{R"({"type":"state","id":1})", kUnknownType, "; allowed types: hello, key", 1},
        Bad{R"({"type":"undo","id":"x"})", kBadMessage, "undo: /id must be a number", {}},
        Bad{R"({"type":"undo","id":2,"x":1})", kBadMessage, "undo: unknown member 'x'; allowed members: id, type", 2},
        Bad{R"({"type":"key","id":2})", kBadMessage, "key: /key is missing; it must be the key as typed", 2},
        Bad{R"({"type":"key","id":2,"key":""})", kBadMessage, "key: /key must be the key as typed", 2},
        Bad{R"({"type":"key","id":2,"key":"y","shift":1})", kBadMessage, "key: /shift must be true or false, not 1", 2},
        Bad{R"({"type":"key","id":2,"keys":"y"})", kBadMessage, "key: /key is missing", 2},
        Bad{R"({"type":"rotate","id":2,"angle":[1]})", kBadMessage, "rotate: /planes is missing", 2},
        Bad{R"({"type":"rotate","id":2,"planes":["xw"],"angles":[1],"angel":2})", kBadMessage,
            "unknown member 'angel' (did you mean 'angles'?)", 2},
        Bad{R"({"type":"rotate","id":2,"planes":["xw"],"angles":["1"]})", kBadMessage,
            "/angles/0 must be a finite number of radians", 2},
        Bad{R"({"type":"rotate","id":2,"planes":["xw","xw"],"angles":[1,2]})", kBadMessage,
            "rotate: /planes must be different planes; xw stands twice", 2},
        Bad{R"({"type":"rotate","id":2,"planes":[],"angles":[1]})", kBadMessage,
            "rotate: /planes must be an array of different planes", 2},
        Bad{R"({"type":"rotate","id":2,"planes":["xq"],"angles":[1]})", kBadMessage,
            "rotate: /planes/0 must be one of the planes", 2},
        Bad{R"({"type":"rotate","id":2,"planes":"xw","angles":[1]})", kBadMessage,
            "rotate: /planes must be an array of different planes", 2},
        Bad{R"({"type":"rotate","id":2,"planes":["xw"],"angles":[1,2]})", kBadMessage,
            "one angle for each plane: 1, not 2", 2},
        Bad{R"({"type":"rotate","id":2,"planes":["xw","yz"],"angles":[1]})", kBadMessage,
            "one angle for each plane: 2, not 1", 2},
        Bad{R"({"type":"rotate","id":2,"planes":["xw"],"angles":[]})", kBadMessage,
            "rotate: /angles must be one angle for each plane", 2}));

INSTANTIATE_TEST_SUITE_P(
    Values, BadMessages,
    testing::Values(
        Bad{R"({"type":"set","id":3,"slices":{"count":0}})", kOutOfRange,
            "set: /slices/count must be an odd number of slices", 3},
        Bad{R"({"type":"set","id":3,"slices":{"count":2.5}})", kBadMessage, "set: /slices/count must be", 3},
        Bad{R"({"type":"set","id":3,"slices":{"spacing":0}})", kOutOfRange,
            "set: /slices/spacing must be a distance greater than 0, not 0", 3},
        Bad{R"({"type":"set","id":3,"slices":{"cuont":3}})", kBadMessage,
            "set: /slices: unknown member 'cuont' (did you mean 'count'?)", 3},
        Bad{R"({"type":"set","id":3,"slices":3})", kBadMessage, "set: /slices must be an object", 3},
        Bad{R"({"type":"set","id":3,"slices":{"focus":1e300}})", kBadMessage, "set: /slices/focus must be", 3},
        Bad{R"({"type":"set","id":3,"slices":{"focus":99999999999999999999}})", kBadMessage,
            "set: /slices/focus must be", 3},
        Bad{R"({"type":"set","id":3,"alpha":7})", kOutOfRange,
            "set: /alpha must be an angle from −2π to 2π, in radians, not 7", 3},
        Bad{R"({"type":"set","id":3,"alpha":-7.123456789})", kOutOfRange, "in radians, not −7.12346", 3},
        Bad{R"({"type":"set","id":3,"alpha":null})", kBadMessage, "set: /alpha must be an angle", 3},
        Bad{R"({"type":"set","id":3,"view":"oblong"})", kBadMessage,
            "set: /view must be " + quotedViews() + ", not 'oblong'", 3},
        Bad{R"({"type":"set","id":3,"polytope":""})", kBadMessage, "set: /polytope must be the name of a polytope", 3},
        Bad{R"({"type":"set","id":3,"polytope":{}})", kBadMessage, "set: /polytope/name is missing", 3},
        Bad{R"({"type":"set","id":3,"polytope":5})", kBadMessage, "set: /polytope must be the name", 3},
        Bad{R"({"type":"set","id":3,"orientation":[[1,0,0],[0,1,0],[0,0,1]]})", kBadMessage, "set: /orientation", 3},
        Bad{R"({"type":"set","id":3,"orientation":[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,9]]})", kOutOfRange,
            "set: /orientation/3/3 must be a number from −1.001", 3},
        Bad{R"({"type":"set","id":3,"shown":{"faces":"no"}})", kBadMessage,
            "set: /shown/faces must be true or false, not 'no'", 3},
        Bad{R"({"type":"set","id":3,"camera":{"zoom":0}})", kOutOfRange, "set: /camera/zoom must be a magnification",
            3},
        Bad{R"({"type":"set","id":3,"polytpoe":"5-cell"})", kBadMessage, "did you mean 'polytope'?", 3},
        Bad{R"({"type":"hello","id":3,"stream":"video"})", kBadMessage,
            "hello: /stream must be \"none\", \"geometry\" or \"frames\", not 'video'", 3},
        Bad{R"({"type":"hello","id":3,"stream":"frames","width":0,"height":720})", kOutOfRange,
            "hello: /width must be a whole number of pixels from 1, not 0", 3},
        Bad{R"({"type":"hello","id":3,"width":1e10})", kOutOfRange, "hello: /width must be", 3},
        Bad{R"({"type":"hello","id":3,"width":12.5})", kBadMessage, "hello: /width must be", 3},
        Bad{R"({"type":"get","id":3,"what":"all"})", kBadMessage, "get: /what must be", 3},
        Bad{R"({"type":"get","id":3,"what":"frame","width":10})", kBadMessage, "/width and /height together", 3},
        Bad{R"({"type":"shown","id":3,"revision":-1})", kOutOfRange, "shown: /revision must be", 3},
        Bad{R"({"type":"load","id":3,"name":"x","format":"off"})", kBadMessage, "load: /data is missing", 3},
        Bad{R"({"type":"command","id":3,"line":7})", kBadMessage, "command: /line must be", 3}));

TEST(Parse, DeepNestingIsLimitedWhereTheCallerSays) {
    EXPECT_TRUE(std::holds_alternative<Request>(parseRequest(R"({"type":"rotate","planes":["xw"],"angles":[1]})", 2)));
    EXPECT_TRUE(
        std::holds_alternative<BadRequest>(parseRequest(R"({"type":"rotate","planes":["xw"],"angles":[1]})", 1)));
}

TEST(Parse, ManyBadNumbersAreNoWork) {
    std::string text = R"({"type":"rotate","angles":[)";
    for (int i = 0; i < 100'000; ++i) text += "NaN,";
    text += "1]}";
    EXPECT_TRUE(std::holds_alternative<BadRequest>(parseRequest(text)));
}

TEST(Parse, LongStringsBesideABadNumberAreNoWork) {
    const std::string word(8 << 20, 'a');  // an algorithm with quadratic time would take hours
    const auto result = parseRequest(R"({"type":"undo","x":")" + word + R"(\"NaN","id":5,"y":NaN})");
    const auto& bad = std::get<BadRequest>(result);
    EXPECT_EQ(bad.id, 5);
    EXPECT_FALSE(bad.notJson);
}

TEST(Parse, ManyValuesAreRefused) {
    std::string text = R"({"type":"rotate","planes":["xw"],"angles":[)";
    for (int i = 0; i < 1'000'000; ++i) text += "\"\",";
    const auto result = parseRequest(text + "1]}");
    const auto& bad = std::get<BadRequest>(result);
    EXPECT_EQ(bad.error.message, "the message holds too many values; at most 10000 are allowed");
    EXPECT_FALSE(bad.notJson);
}

TEST(Quotes, KeepToPrintableText) {
    EXPECT_EQ(text::inQuotes("24-cell"), "'24-cell'");
    EXPECT_EQ(text::inQuotes("a\n\x7f\xff\xe2\x82"), "'a" + std::string(5, '?') + "'");
    EXPECT_EQ(text::inQuotes("π"), "'π'");
    // Overlong forms, surrogates and code points above U+10FFFF are not valid UTF-8 (RFC 3629, sections 3 and 4).
    for (const char* wrong : {"\xc0\xaf", "\xe0\x8c\x8f", "\xed\xa0\x80", "\xf0\x80\x80\x80", "\xf4\x90\x80\x80"}) {
        EXPECT_FALSE(text::isUtf8(wrong));
        EXPECT_EQ(text::inQuotes(wrong), "'" + std::string(std::string_view(wrong).size(), '?') + "'");
    }
    for (const char* right :
         {"", "a", "\xc2\x80", "\xe0\xa0\x80", "\xed\x9f\xbf", "\xf0\x90\x80\x80", "\xf4\x8f\xbf\xbf"})
        EXPECT_TRUE(text::isUtf8(right)) << right;
    EXPECT_EQ(text::inQuotes(std::string(59, 'x') + "πx"), "'" + std::string(59, 'x') + "π…'");
}

TEST(Parse, LongTextsAreNotEchoed) {
    const auto result = parseRequest(R"({"type":")" + std::string(100'000, 'x') + "\"}");
    EXPECT_LT(std::get<BadRequest>(result).error.message.size(), 400U);
}

}  // namespace
}  // namespace oval4d::wire
