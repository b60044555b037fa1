#pragma once
// A value for each setting, for tests that no setting is lost when a state is converted or sent.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "protocol_data/embedded_files.hpp"
#include "session/setting_table.hpp"
#include "session/setting_text.hpp"
#include "session/settings.hpp"
#include "unit/session/support.hpp"

namespace oval4d::session {

/// A setting with a value: its name, the value, the command that shows an object with this setting, and a function that
/// returns whether a state has the value.
struct SettingValue {
    std::string name, value, object;
    std::function<bool(const State&)> isIn;
    std::string place;  ///< the place of the setting in a message, as a JSON pointer (RFC 6901)
    /// The value in a message.
    nlohmann::json message;
};

/// Returns the properties in the schema called `schema`.
inline nlohmann::json propertiesIn(const std::string& schema) {
    return nlohmann::json::parse(protocol_data::embeddedFile("schema/" + schema + ".schema.json")).at("properties");
}

/// Returns the schema of a setting. Settings are in settings.schema.json, except visible parts, which are in
/// parts.schema.json.
inline nlohmann::json schemaOf(const SettingName& name) {
    const std::string object(name.object), member(name.member);
    if (object == "shown") return propertiesIn("parts").at(member);
    const nlohmann::json settings = propertiesIn("settings");
    return object.empty() ? settings.at(member) : settings.at(object).at("properties").at(member);
}

/// Returns a value of a message in the form of the command line.
inline std::string lineText(const nlohmann::json& value) {
    if (value.is_boolean()) return value.get<bool>() ? "on" : "off";
    if (value.is_string()) return value.get<std::string>();
    if (value.is_array()) {
        std::string list;
        for (const nlohmann::json& each : value) list += (list.empty() ? "" : ",") + lineText(each);
        return list;
    }
    if (value.is_number()) return value.dump();
    if (value.contains("element")) return lineText(value.at("element")) + ":" + lineText(value.at("number"));
    // A control point of the fog.
    std::string point = lineText(value.at("value")) + ":" + lineText(value.at("opacity"));
    if (value.contains("color")) {
        char digits[16];
        std::snprintf(digits, sizeof digits, "%06x", value.at("color").get<unsigned>());
        point += std::string(":") + digits;
    }
    return point;
}

/// Returns a value of a setting that is not its initial value: the first example in the schema or, without examples,
/// the opposite of the default.
inline nlohmann::json exampleOf(const SettingName& name) {
    const nlohmann::json schema = schemaOf(name);
    if (schema.contains("examples")) return schema.at("examples").at(0);
    EXPECT_TRUE(schema.contains("default") && schema.at("default").is_boolean())
        << "the schema of " << name.text << " needs \"examples\", with a value that is not the initial one";
    return !schema.value("default", false);
}

/// Returns a function that returns whether a setting has this value in a state.
inline std::function<bool(const State&)> isTextIn(const std::string& name, const std::string& value) {
    ChangeSettings set;
    const auto done = parseSetting(name, value, set);
    EXPECT_TRUE(done) << name << ": " << done.error().message;
    return [wanted = settingTexts(set)](const State& state) {
        const QueryParameters texts = settingTexts(settingsOf(state));
        return std::ranges::find(texts, wanted.at(0)) != texts.end();
    };
}

/// Returns a value for each setting that is not the setting's initial value.
inline std::vector<SettingValue> settingValues() {
    std::vector<SettingValue> values{{"polytope", "16-cell", "polytope 8-cell",
                                      [](const State& state) { return infoOf(state).name == "16-cell"; }, "/polytope",
                                      "16-cell"}};
    forEachSetting([&]<typename Row>(const Row& setting) {
        const auto& [text, object, member] = setting.name;
        const nlohmann::json example = exampleOf(setting.name);
        SettingValue value{std::string(text),
                           lineText(example),
                           setting.forFields ? "formula x^2+y^2 < w" : "polytope truncated tesseract",
                           {},
                           (object.empty() ? "" : "/" + std::string(object)) + "/" + std::string(member),
                           example};
        if constexpr (Row::kIsInState) {
            value.isIn = isTextIn(value.name, value.value);
        } else if (text == "w") {
            value.isIn = [w = example.get<double>()](const State& state) {
                return std::abs(state.focusW() - w) < 1e-12;
            };
        } else {
            EXPECT_TRUE(text == "turning" || text == "playing") << "this function must know where " << text << " is";
            value.isIn = [flag = text == "turning" ? &State::turning : &State::playing](const State& state) {
                return state.*flag;
            };
        }
        values.push_back(std::move(value));
    });
    return values;
}

/// Returns a session with an object that has this setting, before the setting is changed.
inline Session sessionBefore(const SettingValue& setting) {
    Session session;
    line(session, setting.object);
    press(session, "2");  // a rotation, which `turning` repeats
    return session;
}

/// Returns a session in which the setting has this value.
inline Session sessionWith(const SettingValue& setting) {
    Session session = sessionBefore(setting);
    EXPECT_FALSE(setting.isIn(session.current)) << setting.name << " has this value initially";
    line(session, "set " + setting.name + "=" + setting.value);
    return session;
}

}  // namespace oval4d::session
