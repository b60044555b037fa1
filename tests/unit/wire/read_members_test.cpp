// Tests that parse.cpp reads every member of those messages that are not described with Boost.Describe.

#include <boost/describe/members.hpp>
#include <boost/mp11/algorithm.hpp>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "export/export_request.hpp"
#include "session/query.hpp"
#include "session/setting_table.hpp"
#include "unit/session/setting_values.hpp"
#include "unit/wire/support.hpp"
#include "wire/request.hpp"

namespace oval4d::wire {
namespace {

using nlohmann::json;

/// A message, and values that replace or add members of the message. The message is valid with each of these values
/// alone.
struct Variation {
    const char* message;
    const char* values;
};
using Variations = std::vector<Variation>;

// Returns variations of each type of message without described members. The variations contain a value for each member
// of the schema. The file does not compile if a type has no variations.

Variations variationsOf(std::type_identity<Hello> /*type*/) {
    return {{R"({"type": "hello", "width": 100, "height": 100})",
             R"({"stream": "frames", "encoding": "cbor", "scheme": "light", "width": 200, "height": 200,
                 "token": "secret"})"}};
}
Variations variationsOf(std::type_identity<session::Rotate> /*type*/) {
    return {{R"({"type": "rotate", "planes": ["xy"], "angles": [1]})",
             R"({"planes": ["xz"], "angles": [2], "continues": true})"}};
}
Variations variationsOf(std::type_identity<session::ChangeSettings> /*type*/) {
    return {{R"({"type": "set", "polytope": "mine"})",
             R"({"polytope": "24-cell", "orientation": [[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]],
                 "field": {"formula": "x", "box": [[-1, 1], [-1, 1], [-1, 1], [-1, 1]]},
                 "last": {"planes": ["xy"], "angles": [1]}, "continues": true})"}};
}
Variations variationsOf(std::type_identity<session::LoadObject> /*type*/) {
    return {{R"({"type": "load", "name": "a", "format": "npy", "data": "x"})",
             R"({"name": "b", "format": "netcdf", "data": "y", "continues": true, "axes": "xyzw", "variable": "v",
                 "values": "x", "values_variable": "u", "center": "origin", "append": true,
                 "box": [[0, 1], [0, 1], [0, 1], [0, 1]]})"},
            {R"({"type": "load", "name": "a", "path": "p"})",
             R"({"path": "q", "region": [[0, 1], [0, 1], [0, 1], [0, 1]]})"}};
}
Variations variationsOf(std::type_identity<Get> /*type*/) {
    return {{R"({"type": "get", "what": "slices", "width": 100, "height": 100})",
             R"({"what": "frame", "width": 200, "height": 200, "background": "white",
                 "highlight": {"element": "cell", "number": 1}})"},
            {R"({"type": "get", "what": "at", "x": 1, "y": 1})", R"({"x": 2, "y": 2})"},
            {R"({"type": "get", "what": "at", "point": [1, 2, 3, 4]})", R"({"point": [1, 2, 3, 5]})"},
            {R"({"type": "get", "what": "file", "format": "stl"})",
             R"({"format": "3mf", "of": "oval", "body": "skeleton", "size": 10, "label": "engraved", "at": [1],
                 "fit": 3, "exact": true})"}};
}

template <typename Body>
Body bodyOf(const json& message) {
    const Request request = parsed(message.dump());
    if constexpr (boost::mp11::mp_contains<session::Command, Body>::value) {
        return std::get<Body>(std::get<session::Command>(request.body));
    } else {
        return std::get<Body>(request.body);
    }
}

template <typename Body>
bool isSame(const Body& a, const Body& b) {
    return a == b;
}
// Returns whether two ChangeSettings commands are equal. Compares only members outside the table of settings, because
// the table has tests of its own.
bool isSame(const session::ChangeSettings& a, const session::ChangeSettings& b) {
    const auto own = [](const session::ChangeSettings& set) {
        return std::tie(set.continues, set.object, set.formula, set.orientation, set.lastTurn);
    };
    return own(a) == own(b);
}

/// Returns the members of a message that parse.cpp does not read one by one: settings in the table, and members that
/// the schema calls ignored.
std::set<std::string> membersReadOtherwise(const std::string& type, const json& properties) {
    std::set<std::string> names{"type", "id"};
    for (const auto& [name, schema] : properties.items()) {
        if (schema.value("description", "").starts_with("Ignored.")) names.insert(name);
    }
    if (type == session::ChangeSettings::kMessageType) {
        session::forEachSetting([&](const auto& setting) {
            names.emplace(setting.name.object.empty() ? setting.name.member : setting.name.object);
        });
    }
    return names;
}

TEST(ReadMembers, AreThoseOfTheSchemas) {
    using Bodies = boost::mp11::mp_flatten<decltype(Request::body)>;
    using Types = boost::mp11::mp_transform<std::type_identity, Bodies>;
    boost::mp11::mp_for_each<Types>([]<typename Body>(std::type_identity<Body> /*type*/) {
        if constexpr (!boost::describe::has_describe_members<Body>::value) {
            const std::string type(Body::kMessageType);
            const json properties = readSchema(type + ".schema.json").at("properties");
            std::set<std::string> read = membersReadOtherwise(type, properties), inSchema;
            for (const auto& [name, schema] : properties.items()) inSchema.insert(name);
            for (const Variation& variation : variationsOf(std::type_identity<Body>())) {
                const json message = fitting(variation.message), values = json::parse(variation.values);
                for (const auto& [name, value] : values.items()) {
                    SCOPED_TRACE(type + ": " + name);
                    json changed = message;
                    changed[name] = value;
                    EXPECT_FALSE(isSame(bodyOf<Body>(message), bodyOf<Body>(changed))) << "the member is ignored";
                    read.insert(name);
                }
            }
            EXPECT_EQ(read, inSchema) << type;
        }
    });
}

// The options of exports are the parameters that session::kFileParameters lists. The list exists, because the folder
// session/ does not read these options.
TEST(ReadMembers, TheOptionsOfFilesAreThoseOfQueries) {
    std::set<std::string_view> options;
    exports::ExportRequest request;
    exports::forEachOption(request, [&](std::string_view name, const auto& /*value*/) { options.insert(name); });
    EXPECT_EQ(options, std::set<std::string_view>(session::kFileParameters.begin(), session::kFileParameters.end()));
}

}  // namespace
}  // namespace oval4d::wire
