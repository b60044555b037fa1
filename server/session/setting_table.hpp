#pragma once
// The table of settings. All code that reads or writes settings uses it: for the page's command line, the queries of
// addresses, the messages `set` and `state`, and the keys that step through values.

#include <cstdint>
#include <string_view>
#include <type_traits>
#include <utility>

#include "geometry/range.hpp"
#include "session/command.hpp"
#include "session/session.hpp"
#include "slicing/object.hpp"

namespace oval4d::session {

/// The names of a setting on the command line and in messages.
struct SettingName {
    std::string_view text;  ///< the name on the page's command line and in queries
    /// The name of the JSON object that contains the setting in messages, such as "camera"; empty for the message
    /// itself.
    std::string_view object{};
    std::string_view member = text;  ///< the name of the setting in this JSON object
};

/// The unit of angles in error messages.
inline constexpr std::string_view kRadians = " radians";

/// The rule of a setting that may have every value of its type.
struct AnyValueRule {};
/// The steps by which keys change the number of a setting called NAME, within its range. By default, no keys change the
/// number.
struct KeyStepSize {
    /// If not 0, the setting has the actions NAME_larger and NAME_smaller, and its number must be positive. With f =
    /// 2^(1/perDoubling), an action rounds the number to the nearest power of f, and then multiplies or divides it by
    /// f. So each action exactly undoes the other, and `perDoubling` steps lead from 1 to exactly 2.
    int perDoubling = 0;
    /// If not null, the action NAME_up adds this member of the state to the number, and NAME_down subtracts it.
    double State::* amount = nullptr;
};
/// The rule of a numeric setting: only numbers in `range` are accepted.
struct NumberRangeRule {
    std::string_view what;  ///< the subject of the error message, such as "the eye"
    geometry::NumberRange range;
    std::string_view unit{};  ///< the unit that the error message states after the range, such as " circumradii"
    KeyStepSize keys = {};
};
/// The rule of a setting that applySet() checks and changes with code of its own, not by a rule in the table.
struct CheckedByApplySetRule {};

/// The value of Setting::ofState for settings that are not read from a state. Such settings change other settings or
/// the motion.
struct NoStateValue {};

/// The occasion on which a setting returns to its initial value.
enum class ResetOccasion : std::uint8_t {
    never,              ///< never (but a new object of another size changes the setting `spacing` in proportion)
    by_another_object,  ///< when another object is shown, because the value belongs to the old object
    by_reset_or_another_object,  ///< when another object is shown, and after the command `reset`
};

/// A setting. `ofSet` takes a ChangeSettings, and returns a reference to the setting's value in it (a std::optional).
/// `ofState` takes a State, and returns the setting's value in it: by reference if the value is one member of the
/// State, else by value. If by value, the rule must be CheckedByApplySetRule.
template <typename OfSet, typename OfState, typename Rule>
struct Setting {
    static constexpr bool kIsInState = !std::is_same_v<OfState, NoStateValue>;
    static constexpr bool kHasRange = std::is_same_v<Rule, NumberRangeRule>;
    static constexpr bool kIsCheckedByApplySet = std::is_same_v<Rule, CheckedByApplySetRule>;

    SettingName name;
    OfSet ofSet;
    OfState ofState;
    Rule rule;
    ResetOccasion setBack;
    bool forFields;  ///< whether the setting exists only for fields

    /// Returns whether the setting is an angle. Its value is in radians; its text may have a unit.
    bool isAngle() const {
        if constexpr (kHasRange) return rule.unit == kRadians;
        return false;
    }
};
template <typename OfSet, typename OfState, typename Rule>
Setting(SettingName, OfSet, OfState, Rule, ResetOccasion, bool) -> Setting<OfSet, OfState, Rule>;

/// Calls `visit` with each setting except the object, the orientation and the last rotation. Settings in the same JSON
/// object of a message are visited one after another.
template <typename Visitor>
void forEachSetting(const Visitor& visit) {
    using scene::Look;
    // Returns a function of a state that returns a reference to state.*m1.*m2…, for pointers to members m1, m2, …
    const auto at = [](auto... members) {
        return [members...](auto& state) -> auto& { return (state.*....*members); };
    };
    using enum ResetOccasion;
    // Visits a setting that applySet() checks and changes with code of its own. `member` is its member of
    // ChangeSettings.
    const auto visitWithOwnCode = [&](const SettingName& name, auto ChangeSettings::* member, auto ofState,
                                      ResetOccasion setBack, bool forFields = false) {
        const auto ofSet = [member](auto& set) -> auto& { return set.*member; };
        visit(Setting{name, ofSet, ofState, CheckedByApplySetRule{}, setBack, forFields});
    };
    // Visits a setting that applySet() only stores, if `rule` allows the value. Its new value is in
    // ChangeSettings::plain.
    const auto visitPlain = [&](const SettingName& name, auto ofState, auto rule, ResetOccasion setBack,
                                bool forFields = false) {
        using Value = std::remove_cvref_t<decltype(ofState(std::declval<State&>()))>;
        const auto ofSet = [text = name.text](auto& set) -> auto& { return set.plain.template valueOf<Value>(text); };
        visit(Setting{name, ofSet, ofState, rule, setBack, forFields});
    };

    const auto frame = &State::referenceFrame;
    visitWithOwnCode({"pace"}, &ChangeSettings::pace, at(frame, &geometry::ReferenceFrame::pace), never);
    visitWithOwnCode({"follow"}, &ChangeSettings::follow, at(frame, &geometry::ReferenceFrame::follow), never);
    visitWithOwnCode({"boost"}, &ChangeSettings::boost, at(frame, &geometry::ReferenceFrame::boost), never);
    visitPlain({"alpha"}, at(&State::alpha),
               NumberRangeRule{"alpha", State::kAngleRange, kRadians, {.amount = &State::step}}, never);
    visitPlain({"beta"}, at(&State::beta),
               NumberRangeRule{"beta", State::kAngleRange, kRadians, {.amount = &State::step}}, never);
    visitPlain({"step"}, at(&State::step), NumberRangeRule{"the step", State::kStepRange, kRadians}, never);

    const auto slices = &State::slices;
    visitWithOwnCode({"slices", "slices", "count"}, &ChangeSettings::count, at(slices, &HyperplaneSettings::count),
                     never);
    visitWithOwnCode({"spacing", "slices"}, &ChangeSettings::spacing, at(slices, &HyperplaneSettings::spacing), never);
    visitWithOwnCode({"focus", "slices"}, &ChangeSettings::focus, at(slices, &HyperplaneSettings::focus),
                     by_reset_or_another_object);
    visitWithOwnCode({"offset", "slices"}, &ChangeSettings::offset, at(slices, &HyperplaneSettings::offset),
                     by_reset_or_another_object);
    visitWithOwnCode({"w", "slices"}, &ChangeSettings::focusW, NoStateValue{}, never);
    visitWithOwnCode(
        {"point"}, &ChangeSettings::focusPoint, [](const State& state) { return state.focusPointInFile(); },
        by_another_object);

    const auto look = &State::look;
    visitPlain({"view"}, at(look, &Look::view), AnyValueRule{}, never);
    visitWithOwnCode({"turning"}, &ChangeSettings::turning, NoStateValue{}, never);
    visitWithOwnCode({"playing"}, &ChangeSettings::playing, NoStateValue{}, never);
    visitPlain({"speed"}, at(&State::playSpeed),
               NumberRangeRule{"the speed", State::kPlaySpeedRange, "", {.perDoubling = 1}}, never);
    const auto orbit = &Look::orbit;
    using Orbit = scene::CameraOrbit;
    visitPlain({"azimuth", "camera"}, at(look, orbit, &Orbit::azimuth),
               NumberRangeRule{"the camera's azimuth", Orbit::kAngleRange, kRadians}, never);
    visitPlain({"elevation", "camera"}, at(look, orbit, &Orbit::elevation),
               NumberRangeRule{"the camera's elevation", Orbit::kAngleRange, kRadians}, never);
    visitPlain({"zoom", "camera"}, at(look, orbit, &Orbit::zoom),
               NumberRangeRule{"the camera's zoom", Orbit::kZoomRange}, never);
    visitPlain({"color"}, at(look, &Look::coloring), AnyValueRule{}, never);
    visitPlain({"background"}, at(look, &Look::background), AnyValueRule{}, never);
    visitPlain({"thickness"}, at(look, &Look::thickness),
               NumberRangeRule{"the thickness", Look::kThicknessRange, "", {.perDoubling = 4}}, never);
    visitPlain({"opacity"}, at(look, &Look::opacity),
               NumberRangeRule{"the opacity", Look::kOpacityRange, "", {.perDoubling = 4}}, never);
    const auto projection = &Look::projection;
    using Projection = scene::ProjectionSettings;
    visitPlain({"projection"}, at(look, projection, &Projection::kind), AnyValueRule{}, never);
    visitPlain({"eye"}, at(look, projection, &Projection::eye),
               NumberRangeRule{"the eye", Projection::kEyeRange, " circumradii"}, never);
    const auto field = &Look::field;
    visitWithOwnCode({"levels"}, &ChangeSettings::levels, at(look, field, &slicing::FieldSettings::levels),
                     by_another_object, true);
    visitWithOwnCode({"inside"}, &ChangeSettings::inside, at(look, field, &slicing::FieldSettings::inside),
                     by_another_object, true);
    visitPlain({"caps"}, at(look, &Look::caps), AnyValueRule{}, never, true);
    visitWithOwnCode({"fog"}, &ChangeSettings::fog, at(look, field, &slicing::FieldSettings::fog), by_another_object,
                     true);
    const auto cellTypes = &Look::cellTypes;
    visitWithOwnCode({"hidden"}, &ChangeSettings::hidden, at(look, cellTypes, &scene::CellTypeFilter::hidden),
                     by_another_object);
    visitWithOwnCode({"faded"}, &ChangeSettings::faded, at(look, cellTypes, &scene::CellTypeFilter::faded),
                     by_another_object);
    visitWithOwnCode({"highlight"}, &ChangeSettings::highlight, at(look, &Look::highlight), by_another_object);

    for (const scene::NamedPicturePart& part : scene::kParts)
        visitPlain({part.name, "shown"}, at(look, &Look::parts, part.flag), AnyValueRule{}, never);
}

}  // namespace oval4d::session
