// Tests that the data files and the specification in protocol/ agree with the code.

#include <algorithm>
#include <boost/describe/members.hpp>
#include <boost/describe/modifiers.hpp>
#include <boost/mp11/algorithm.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <numbers>
#include <set>
#include <sstream>
#include <type_traits>
#include <utility>

#include <gtest/gtest.h>

#include "session/setting_table.hpp"
#include "text/message_text.hpp"
#include "unit/session/setting_values.hpp"
#include "unit/wire/support.hpp"
#include "wire/request.hpp"
#include "wire/state_message.hpp"

namespace oval4d::wire {
namespace {

using nlohmann::json;

std::string textOf(const std::string& path) {
    std::ifstream file(std::string(OVAL4D_SOURCE_DIR) + "/" + path);
    EXPECT_TRUE(file) << path;
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

/// Returns all message types: the names of the schemas of objects with a constant "type".
std::set<std::string> messageTypes() {
    constexpr std::string_view kEnding = ".schema.json";
    std::set<std::string> types;
    for (const auto& entry : std::filesystem::directory_iterator(OVAL4D_SOURCE_DIR "/protocol/schema")) {
        const std::string file = entry.path().filename();
        if (!file.ends_with(kEnding)) continue;
        const json schema = json::parse(protocol_data::embeddedFile("schema/" + file));
        if (schema.value("/properties/type/const"_json_pointer, json()).is_string())
            types.insert(file.substr(0, file.size() - kEnding.size()));
    }
    return types;
}

json errors() { return json::parse(protocol_data::embeddedFile("errors.json")); }

TEST(Tables, TheErrorsAreThoseOfTheCode) {
    const json table = errors().at("errors");
    ASSERT_EQ(table.size(), static_cast<std::size_t>(ErrorCode::internal) + 1);
    const json schema = json::parse(protocol_data::embeddedFile("schema/error.schema.json"));
    const auto inSchema = schema.at("properties").at("code").at("enum").get<std::set<std::string>>();
    for (std::size_t i = 0; i < table.size(); ++i) {
        EXPECT_EQ(table[i].at("code"), protocolName(static_cast<ErrorCode>(i)));
        EXPECT_FALSE(table[i].at("meaning").get<std::string>().empty());
        EXPECT_FALSE(table[i].at("hint").get<std::string>().empty());
        EXPECT_EQ(inSchema.count(table[i].at("code")), 1U);
    }
    EXPECT_EQ(inSchema.size(), table.size());
}

TEST(Tables, EveryExampleOfTheSpecificationFitsItsSchema) {
    const std::string text = textOf("protocol/README.md");
    constexpr std::string_view kOpening = "```json\n";
    std::set<std::string> seen;
    for (std::size_t at = 0; (at = text.find(kOpening, at)) != std::string::npos;) {
        at += kOpening.size();
        const std::size_t end = text.find("```", at);
        ASSERT_NE(end, std::string::npos);
        std::istringstream examples(text.substr(at, end - at));
        std::string line, example;
        while (std::getline(examples, line)) {
            example += line;
            if (!json::accept(example)) continue;  // an example may extend over several lines
            SCOPED_TRACE(example);
            const std::string type = json::parse(example).at("type");
            fitting(example);
            if (std::find(requestTypes().begin(), requestTypes().end(), type) != requestTypes().end()) {
                EXPECT_NO_THROW(parsed(example));
            }
            seen.insert(type);
            example.clear();
        }
        EXPECT_TRUE(example.empty()) << "not JSON: " << example;
        at = end + 3;
    }
    EXPECT_EQ(seen, messageTypes()) << "an example of each message";
}

// Expects that a schema has only keywords that valijson checks. valijson silently ignores other keywords.
void expectKnownKeywords(const json& schema, const std::string& where) {
    static const std::set<std::string> known{"$schema",
                                             "$anchor",
                                             "title",
                                             "description",
                                             "type",
                                             "const",
                                             "enum",
                                             "unevaluatedProperties",
                                             "required",
                                             "properties",
                                             "additionalProperties",
                                             "items",
                                             "minItems",
                                             "maxItems",
                                             "minimum",
                                             "maximum",
                                             "exclusiveMinimum",
                                             "minLength",
                                             "maxLength"};
    if (!schema.is_object()) return;
    if (schema.contains("$ref")) {
        const std::string reference = schema.at("$ref");
        if (reference.starts_with('#')) return;  // "$defs" contains this part, which is checked there
        expectKnownKeywords(readSchema(reference), where + "/" + reference);
    }
    for (const auto& [keyword, content] : schema.items()) {
        if (keyword == "$ref" || keyword == "default" || keyword == "examples" || keyword.starts_with("x-"))
            continue;  // these keywords check nothing
        if (keyword == "$defs") {
            for (const auto& [name, member] : content.items()) expectKnownKeywords(member, where + "/" + name);
            continue;
        }
        EXPECT_EQ(known.count(keyword), 1U) << where << ": " << keyword;
        if (keyword == "properties") {
            for (const auto& [name, member] : content.items()) expectKnownKeywords(member, where + "/" + name);
        } else if (keyword == "items" || keyword == "additionalProperties") {
            expectKnownKeywords(content, where + "/" + keyword);
        }
    }
}

TEST(Tables, SetAndStateHaveTheSettings) {
    const json settings = readSchema("settings.schema.json").at("properties");
    const json set = readSchema("set.schema.json"), state = readSchema("state.schema.json");
    EXPECT_EQ(set.at("additionalProperties"), false);
    for (const auto& [name, schema] : settings.items()) {
        EXPECT_EQ(set.at("properties").at(name), schema) << name;
        EXPECT_TRUE(state.at("properties").contains(name)) << name;
    }
    const auto required = state.at("required").get<std::set<std::string>>();
    session::forEachSetting([&]<typename Row>(const Row& setting) {
        if constexpr (Row::kIsInState) {
            const std::string name(setting.name.object.empty() ? setting.name.member : setting.name.object);
            EXPECT_TRUE(settings.contains(name)) << name;
            EXPECT_EQ(required.contains(name), !setting.forFields) << name;
        }
    });
}

/// Expects that the schema of a number allows this range, and that its title states the same bounds, if it states
/// bounds.
void expectRange(const json& schema, const geometry::NumberRange& range) {
    const bool isOpen = schema.contains("exclusiveMinimum");
    const double minimum = schema.at(isOpen ? "exclusiveMinimum" : "minimum"), maximum = schema.at("maximum");
    EXPECT_TRUE(isOpen ? minimum < range.least : minimum == range.least) << minimum << ", not " << range.least;
    EXPECT_EQ(maximum, range.most);
    const auto stated = [](double number) {
        if (std::abs(number) == 2 * std::numbers::pi) return std::string(number < 0 ? "−2π" : "2π");
        return text::roundedDecimal(number);
    };
    const std::string title = schema.value("title", "");
    if (title.find("from ") == std::string::npos) return;
    EXPECT_NE(title.find("from " + stated(minimum) + " to " + stated(maximum)), std::string::npos) << title;
}

TEST(Tables, TheRangesOfSettingsAreThoseOfTheSchema) {
    session::forEachSetting([]<typename Row>(const Row& setting) {
        if constexpr (Row::kHasRange) {
            SCOPED_TRACE(std::string(setting.name.text) + ": the schema and the range in C++ must agree");
            expectRange(session::schemaOf(setting.name), setting.rule.range);
        }
    });
    using geometry::ReferenceFrame;
    const auto symmetric = [](double most) { return geometry::NumberRange{-most, most}; };
    const json settings = readSchema("settings.schema.json").at("properties");
    expectRange(settings.at("pace"), ReferenceFrame::kPaceRange);
    expectRange(settings.at("follow").at("items"), ReferenceFrame::kFollowRange);
    expectRange(settings.at("boost").at("items"), symmetric(ReferenceFrame::kMaxBoost));
    expectRange(settings.at("levels").at("items"), symmetric(slicing::kMaxLevel));
    expectRange(settings.at("fog").at("items").at("properties").at("value"), symmetric(slicing::kMaxLevel));
    expectRange(settings.at("slices").at("properties").at("focus"), symmetric(session::kMaxFocus));
}

TEST(Tables, TheDefaultsOfSettingsAreTheInitialValues) {
    const json state = fitting(stateMessage(session::initialState(), {}, 0));
    session::forEachSetting([&]<typename Row>(const Row& setting) {
        if constexpr (Row::kIsInState) {
            if (setting.forFields) return;  // a new session does not show a field
            const std::string object(setting.name.object), member(setting.name.member);
            const json& value = object.empty() ? state.at(member) : state.at(object).at(member);
            EXPECT_EQ(session::schemaOf(setting.name).value("default", json("none")), value)
                << setting.name.text << ": the schema needs \"default\", the value in a new session";
        }
    });
}

TEST(Tables, TheSpecificationListsTheNamesForSet) {
    const std::string text = textOf("protocol/README.md");
    const std::size_t begin = text.find("<!-- names for set:"), end = text.find("<!-- end of names for set -->");
    ASSERT_LT(begin, end);
    std::set<std::string> listed, names;
    std::istringstream words(text.substr(begin, end - begin));
    for (std::string word; std::getline(words, word, '`') && std::getline(words, word, '`');) listed.insert(word);
    std::istringstream all(session::settingNames());
    for (std::string name; std::getline(all >> std::ws, name, ',');) names.insert(name);
    EXPECT_EQ(listed, names) << "tests/lint makes this list from settings.schema.json: run tests/lint --fix; a setting "
                                "of the command line has the name of its member there, except the number of slices";
}

TEST(Tables, KeywordsBesideAReferenceAreAdded) {
    const json whole = readSchema("state.schema.json");
    const json& merged = whole.at("properties").at("polytope").at("properties").at("kinds").at("items");
    EXPECT_EQ(merged.at("required"), json({"name", "cells", "color"}));
    EXPECT_EQ(merged.at("properties").at("cells").at("type"), "integer");
    EXPECT_EQ(whole.at("properties").at("polytope").at("type"), "object");
    EXPECT_THROW(readSchema("none.schema.json"), json::exception);
    EXPECT_THROW(readSchema("set.schema.json#/properties/none"), json::exception);
}

TEST(Tables, TheSchemasUseWhatIsChecked) {
    for (const std::string& type : messageTypes()) {
        const std::string_view text = protocol_data::embeddedFile("schema/" + type + ".schema.json");
        ASSERT_FALSE(text.empty()) << type;
        const json schema = json::parse(text);
        EXPECT_EQ(schema.at("$schema"), "https://json-schema.org/draft/2020-12/schema");
        EXPECT_EQ(schema.at("properties").at("type").at("const"), type);
        expectKnownKeywords(schema, type);
    }
    EXPECT_TRUE(protocol_data::embeddedFile("schema/none.schema.json").empty());
}

using Names = std::set<std::string>;

template <typename Choices>
Names namesIn(const Choices& choices) {
    const auto names = text::namesOf(choices);
    return {names.begin(), names.end()};
}

/// Calls a function with a std::type_identity of each type in a list of types, such as a variant.
template <typename Types, typename Visit>
void forEachType(const Visit& visit) {
    boost::mp11::mp_for_each<boost::mp11::mp_transform<std::type_identity, Types>>(visit);
}

using RequestBodies = boost::mp11::mp_flatten<decltype(Request::body)>;

TEST(Tables, EveryRequestHasASchemaThatSaysWhatAnswersIt) {
    const std::set<std::string> types = messageTypes();
    Names requests;
    for (const std::string& type : types) {
        const json id =
            json::parse(protocol_data::embeddedFile("schema/" + type + ".schema.json")).at("properties").at("id");
        if (type == "hello" || id.value("$ref", "") == "hello.schema.json#/properties/id") requests.insert(type);
    }
    EXPECT_EQ(requests, Names(requestTypes().begin(), requestTypes().end()));
    forEachType<RequestBodies>([&]<typename Body>(std::type_identity<Body> /*body*/) {
        const std::string type(Body::kMessageType);
        SCOPED_TRACE(type);
        const json answer = readSchema(type + ".schema.json").value("x-answer", json());
        if constexpr (boost::mp11::mp_contains<session::Command, Body>::value || std::is_same_v<Body, Get>) {
            EXPECT_TRUE(answer.is_null()) << "done answers a command, and get names its answer";
        } else {
            EXPECT_TRUE(answer.is_string() && types.contains(answer.get<std::string>())) << answer;
        }
    });
}

TEST(Tables, DescribedMessagesHaveTheMembersOfTheirSchemas) {
    const auto compare = []<typename Message>(std::type_identity<Message> /*message*/) {
        if constexpr (boost::describe::has_describe_members<Message>::value) {
            using Members = boost::describe::describe_members<Message, boost::describe::mod_public>;
            Names described{"type", "id"}, inSchema;
            boost::mp11::mp_for_each<Members>([&](auto member) { described.emplace(member.name); });
            const std::string type(Message::kMessageType);
            const json schema = readSchema(type + ".schema.json");
            for (const auto& [name, property] : schema.at("properties").items()) inSchema.insert(name);
            EXPECT_EQ(described, inSchema) << type;
        }
    };
    forEachType<RequestBodies>(compare);
    forEachType<Answer>(compare);
}

/// Returns the allowed values (enum) of a property. `property` is a path with dots, such as "scene.view".
Names allowedIn(const std::string& type, const std::string& property) {
    json schema = readSchema(type + ".schema.json");
    std::istringstream path(property);
    for (std::string name; std::getline(path, name, '.');) schema = schema.at("properties").at(name);
    return schema.at("enum").get<Names>();
}

TEST(Tables, TheChoicesAreThoseOfTheSchemas) {
    for (const char* type : {"set", "state"}) {
        EXPECT_EQ(allowedIn(type, "view"), namesIn(scene::kViews)) << type;
        EXPECT_EQ(allowedIn(type, "color"), namesIn(scene::kColorings)) << type;
        EXPECT_EQ(allowedIn(type, "projection"), namesIn(scene::kProjectionKinds)) << type;
        EXPECT_EQ(allowedIn(type, "background"), namesIn(scene::kBackgrounds)) << type;
    }
    session::forEachSetting([]<typename Row>(const Row& setting) {
        if constexpr (Row::kIsInState) {
            using Value = std::remove_cvref_t<decltype(setting.ofState(std::declval<session::State&>()))>;
            if constexpr (text::HasChoices<Value>) {
                const json schema = session::schemaOf(setting.name);
                EXPECT_EQ(schema.at("enum").get<Names>(), namesIn(choicesOf(Value{}))) << setting.name.text;
            }
        }
    });
    EXPECT_EQ(allowedIn("settings", "highlight.element"), namesIn(slicing::kElementKinds));
    EXPECT_EQ(allowedIn("get", "background"), namesIn(scene::kBackgrounds));
    EXPECT_EQ(allowedIn("hello", "scheme"), namesIn(scene::kSchemes));
    EXPECT_EQ(allowedIn("slices", "scene.view"), namesIn(scene::kViews));
    EXPECT_EQ(allowedIn("hello", "stream"), namesIn(kStreams));
    EXPECT_EQ(allowedIn("hello", "encoding"), namesIn(kEncodings));
    EXPECT_EQ(allowedIn("get", "what"), namesIn(kGetTargets));
    EXPECT_EQ(allowedIn("get", "of"), namesIn(exports::kExportContents));
    EXPECT_EQ(allowedIn("get", "body"), namesIn(exports::kBodies));
    EXPECT_EQ(allowedIn("get", "label"), namesIn(exports::kLabels));
}

TEST(Tables, TheColorsAreThoseOfTheCode) {
    const json table = json::parse(protocol_data::embeddedFile("colors.json"));
    const auto hex = [](scene::Color color) {
        std::ostringstream text;
        text << '#' << std::hex << std::setfill('0') << std::setw(6) << color;
        return text.str();
    };
    using scene::Background;
    for (const auto& [name, background] :
         {std::pair("dark", Background::dark), {"light", Background::light}, {"white", Background::white}})
        EXPECT_EQ(table.at("grounds").at(name), hex(scene::style(background).background)) << name;
    for (const auto& [name, scheme] : scene::kSchemes) {
        const scene::PictureStyle& style =
            scene::style(scheme == scene::ColorScheme::dark ? Background::dark : Background::white);
        const json expected{{"text", hex(style.text)},
                            {"focus", hex(style.focusText)},
                            {"ball", hex(style.ball)},
                            {"bar", hex(style.bar)},
                            {"zero", hex(style.zeroLine)},
                            {"highlight", hex(style.highlight)},
                            {"axes", {hex(style.axes[0]), hex(style.axes[1]), hex(style.axes[2]), hex(style.axes[3])}},
                            {"faces", style.faceOpacity},
                            {"scale",
                             {hex(scene::divergingColor(-1, scheme)), hex(scene::divergingColor(0, scheme)),
                              hex(scene::divergingColor(1, scheme))}}};
        EXPECT_EQ(table.at("schemes").at(std::string(name)), expected) << name;
    }
}

TEST(Tables, ThePartsAreThoseOfTheSchemas) {
    Names parts;
    for (const scene::NamedPicturePart& part : scene::kParts) parts.emplace(part.name);
    for (const json& schema : {readSchema("set.schema.json"), readSchema("state.schema.json"),
                               readSchema("slices.schema.json").at("properties").at("scene")}) {
        Names shown;
        for (const auto& [name, property] : schema.at("properties").at("shown").at("properties").items()) {
            shown.insert(name);
            EXPECT_EQ(property.at("type"), "boolean") << name;
        }
        EXPECT_EQ(shown, parts);
    }
}

}  // namespace
}  // namespace oval4d::wire
