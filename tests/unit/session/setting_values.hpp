#pragma once
// A value of each setting, for tests that no setting is lost on a way.

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "unit/session/support.hpp"

namespace oval4d::session {

/// A setting: its name, a value, the object that has it, and whether a state holds the value.
struct SettingValue {
    std::string name, value, object;
    std::function<bool(const State&)> isIn;
};

/// Returns a value of each setting that is not its initial one.
inline std::vector<SettingValue> settingValues() {
    constexpr double pi = std::numbers::pi;
    const std::string polytope = "polytope 8-cell", field = "formula x^2+y^2 < w";
    std::vector<SettingValue> values{
        {"polytope", "16-cell", polytope, [](const State& now) { return infoOf(now).name == "16-cell"; }},
        {"pace", "2", polytope, [](const State& now) { return now.referenceFrame.pace == 2; }},
        {"follow", "0.1,0,1/4", polytope,
         [](const State& now) { return now.referenceFrame.follow == glm::dvec3(0.1, 0, 0.25); }},
        {"boost", "0.5,0,0", polytope,
         [](const State& now) { return now.referenceFrame.boost == glm::dvec3(0.5, 0, 0); }},
        {"alpha", "0.1", polytope, [](const State& now) { return now.alpha == 0.1; }},
        {"beta", "-0.2", polytope, [](const State& now) { return now.beta == -0.2; }},
        {"step", "0.01", polytope, [](const State& now) { return now.step == 0.01; }},
        {"slices", "11", polytope, [](const State& now) { return now.slices.count == 11; }},
        {"spacing", "0.2", polytope, [](const State& now) { return now.slices.spacing == 0.2; }},
        {"focus", "-2", polytope, [](const State& now) { return now.slices.focus == -2; }},
        {"offset", "0.05", polytope, [](const State& now) { return now.slices.offset == 0.05; }},
        {"w", "0.3", polytope, [](const State& now) { return std::abs(now.focusW() - 0.3) < 1e-12; }},
        {"point", "0.1,1/4,-pi/10,0", polytope,
         [](const State& now) { return now.look.focusPoint == glm::dvec3(0.1, 0.25, -pi / 10); }},
        {"view", "single", polytope, [](const State& now) { return now.look.view == scene::View::single; }},
        {"azimuth", "0.3", polytope, [](const State& now) { return now.look.orbit.azimuth == 0.3; }},
        {"elevation", "-0.1", polytope, [](const State& now) { return now.look.orbit.elevation == -0.1; }},
        {"zoom", "2", polytope, [](const State& now) { return now.look.orbit.zoom == 2; }},
        {"color", "w", polytope, [](const State& now) { return now.look.coloring == scene::Coloring::w; }},
        {"background", "white", polytope,
         [](const State& now) { return now.look.background == scene::Background::white; }},
        {"projection", "orthogonal", polytope,
         [](const State& now) { return now.look.projection.kind == scene::ProjectionKind::orthogonal; }},
        {"eye", "5", polytope, [](const State& now) { return now.look.projection.eye == 5; }},
        {"levels", "1,1/2", field,
         [](const State& now) { return now.look.field.levels == std::vector<double>{1, 0.5}; }},
        {"inside", "above", field, [](const State& now) { return now.look.field.inside == fields::Inside::above; }},
        {"caps", "open", field, [](const State& now) { return now.look.caps == scene::CapStyle::open; }},
        {"fog", "0:0,8:1", field,
         [](const State& now) { return now.look.field.fog == std::vector<slicing::FogPoint>{{0, 0}, {8, 1}}; }},
        {"hidden", "0", polytope,
         [](const State& now) { return now.look.cellTypes.hidden == std::vector<std::uint32_t>{0}; }},
        {"faded", "0", polytope,
         [](const State& now) { return now.look.cellTypes.faded == std::vector<std::uint32_t>{0}; }},
        {"highlight", "vertex:3", polytope,
         [](const State& now) { return now.look.highlight == slicing::Element{slicing::ElementKind::vertex, 3}; }},
        {"turning", "on", polytope, [](const State& now) { return now.turning; }}};
    for (const scene::NamedPart& part : scene::kParts) {
        const bool shown = !(scene::Parts().*part.flag);
        values.push_back({std::string(part.name), shown ? "on" : "off", polytope,
                          [flag = part.flag, shown](const State& now) { return now.look.parts.*flag == shown; }});
    }
    return values;
}

/// Returns a session that has the value.
inline Session sessionWith(const SettingValue& setting) {
    Session session;
    line(session, setting.object);
    press(session, "2");  // a rotation, which turning repeats
    EXPECT_FALSE(setting.isIn(session.current)) << setting.name << " has this value initially";
    line(session, "set " + setting.name + "=" + setting.value);
    return session;
}

}  // namespace oval4d::session
