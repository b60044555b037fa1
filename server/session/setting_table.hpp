#pragma once
// The table of settings. From it, the page's command line, the queries of addresses, and the messages `set` and `state`
// are read and written.

#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string_view>
#include <type_traits>

#include "session/command.hpp"
#include "session/session.hpp"
#include "session/settings.hpp"
#include "slicing/object.hpp"

namespace oval4d::session {

/// The names of a setting.
struct SettingName {
    std::string_view text;    ///< on the page's command line and in queries
    std::string_view object;  ///< in messages: the name of the JSON object that contains the setting, such as "camera";
                              ///< empty if the message itself contains it
    std::string_view member;  ///< in messages: the name of the setting in this JSON object
};

/// The rule of a setting for which applySet() accepts every value.
struct AcceptsAnyValue {};
/// The rule of a number that applySet() accepts within fixed bounds.
struct NumberWithBounds {
    std::string_view what;  ///< the subject of the error message, such as "the eye"
    Bounds bounds;
};
/// The rule of a setting that applySet() checks and changes with code of its own.
struct CheckedByApplySet {};

/// Takes the place of Setting::ofState in settings that are not read from a state: they change other settings or the
/// motion.
struct NotInState {};

/// What sets a setting back to its initial value.
enum class ResetOccasion : std::uint8_t {
    never,                       ///< nothing; only the spacing changes, in proportion to the size of a new object
    by_another_object,           ///< the replacement of the object, because the value belongs to the object
    by_reset_or_another_object,  ///< the replacement of the object, and the command `reset`
};

/// A setting. `ofSet` returns a reference to the setting's member of a Set, which is a std::optional. `ofState` returns
/// the setting's value in a State: by reference if the value is one member of the State; otherwise by value, and then
/// the rule must be CheckedByApplySet.
template <typename OfSet, typename OfState, typename Rule>
struct Setting {
    static constexpr bool kIsInState = !std::is_same_v<OfState, NotInState>;
    static constexpr bool kHasBounds = std::is_same_v<Rule, NumberWithBounds>;
    static constexpr bool kIsCheckedByApplySet = std::is_same_v<Rule, CheckedByApplySet>;

    SettingName name;
    OfSet ofSet;
    OfState ofState;
    Rule rule;
    ResetOccasion setBack;
    bool forFields;  ///< whether only states with a field have it

    /// Returns whether it is an angle in radians, which may be written with a unit.
    bool isAngle() const {
        if constexpr (kHasBounds) return rule.bounds.unit == kRadians;
        return false;
    }
};
template <typename OfSet, typename OfState, typename Rule>
Setting(SettingName, OfSet, OfState, Rule, ResetOccasion, bool) -> Setting<OfSet, OfState, Rule>;

/// Calls `visit` with each setting except the object, the orientation and the last rotation. Settings that are in the
/// same JSON object of a message are visited one after another.
template <typename Visitor>
void forEachSetting(const Visitor& visit) {
    using scene::Look;
    constexpr double kTwoPi = 2 * std::numbers::pi;
    constexpr Bounds kAngle{-kTwoPi, kTwoPi, kRadians}, kOrbitAngle{-kMaxOrbitAngle, kMaxOrbitAngle, kRadians};
    // Returns a function that returns a reference to state.*m1.*m2…, for pointers to members m1, m2, …
    const auto at = [](auto... members) {
        return [members...](auto& state) -> auto& { return (state.*....*members); };
    };
    const auto setting = [&](const SettingName& name, auto Set::* given, auto ofState, auto rule, ResetOccasion setBack,
                             bool forFields = false) {
        visit(Setting{name, [given](auto& set) -> auto& { return set.*given; }, ofState, rule, setBack, forFields});
    };

    using enum ResetOccasion;
    const auto frame = &State::referenceFrame;
    setting({"pace", "", "pace"}, &Set::pace, at(frame, &geometry::ReferenceFrame::pace), CheckedByApplySet{}, never);
    setting({"follow", "", "follow"}, &Set::follow, at(frame, &geometry::ReferenceFrame::follow), CheckedByApplySet{},
            never);
    setting({"boost", "", "boost"}, &Set::boost, at(frame, &geometry::ReferenceFrame::boost), CheckedByApplySet{},
            never);
    setting({"alpha", "", "alpha"}, &Set::alpha, at(&State::alpha), NumberWithBounds{"alpha", kAngle}, never);
    setting({"beta", "", "beta"}, &Set::beta, at(&State::beta), NumberWithBounds{"beta", kAngle}, never);
    setting({"step", "", "step"}, &Set::step, at(&State::step),
            NumberWithBounds{"the step", {kMinStep, kTwoPi, kRadians}}, never);

    const auto slices = &State::slices;
    setting({"slices", "slices", "count"}, &Set::count, at(slices, &SliceSettings::count), CheckedByApplySet{}, never);
    setting({"spacing", "slices", "spacing"}, &Set::spacing, at(slices, &SliceSettings::spacing), CheckedByApplySet{},
            never);
    setting({"focus", "slices", "focus"}, &Set::focus, at(slices, &SliceSettings::focus), CheckedByApplySet{},
            by_reset_or_another_object);
    setting({"offset", "slices", "offset"}, &Set::offset, at(slices, &SliceSettings::offset), CheckedByApplySet{},
            by_reset_or_another_object);
    setting({"w", "slices", "w"}, &Set::focusW, NotInState{}, CheckedByApplySet{}, never);
    setting(
        {"point", "", "point"}, &Set::focusPoint, [](const State& state) { return state.focusPointInFile(); },
        CheckedByApplySet{}, by_another_object);

    const auto look = &State::look;
    setting({"view", "", "view"}, &Set::view, at(look, &Look::view), AcceptsAnyValue{}, never);
    setting({"turning", "", "turning"}, &Set::turning, NotInState{}, CheckedByApplySet{}, never);
    const auto orbit = &Look::orbit;
    using Orbit = scene::CameraOrbit;
    setting({"azimuth", "camera", "azimuth"}, &Set::azimuth, at(look, orbit, &Orbit::azimuth),
            NumberWithBounds{"the camera's azimuth", kOrbitAngle}, never);
    setting({"elevation", "camera", "elevation"}, &Set::elevation, at(look, orbit, &Orbit::elevation),
            NumberWithBounds{"the camera's elevation", kOrbitAngle}, never);
    setting({"zoom", "camera", "zoom"}, &Set::zoom, at(look, orbit, &Orbit::zoom),
            NumberWithBounds{"the camera's zoom", {kMinZoom, kMaxZoom, ""}}, never);
    setting({"color", "", "color"}, &Set::coloring, at(look, &Look::coloring), AcceptsAnyValue{}, never);
    setting({"background", "", "background"}, &Set::background, at(look, &Look::background), AcceptsAnyValue{}, never);
    const auto projection = &Look::projection;
    setting({"projection", "", "projection"}, &Set::projection, at(look, projection, &scene::ProjectionSettings::kind),
            AcceptsAnyValue{}, never);
    setting({"eye", "", "eye"}, &Set::eye, at(look, projection, &scene::ProjectionSettings::eye),
            NumberWithBounds{"the eye", {kMinEye, kMaxEye, " circumradii"}}, never);
    const auto field = &Look::field;
    setting({"levels", "", "levels"}, &Set::levels, at(look, field, &slicing::FieldSettings::levels),
            CheckedByApplySet{}, by_another_object, true);
    setting({"inside", "", "inside"}, &Set::inside, at(look, field, &slicing::FieldSettings::inside),
            CheckedByApplySet{}, by_another_object, true);
    setting({"caps", "", "caps"}, &Set::caps, at(look, &Look::caps), AcceptsAnyValue{}, never, true);
    setting({"fog", "", "fog"}, &Set::fog, at(look, field, &slicing::FieldSettings::fog), CheckedByApplySet{},
            by_another_object, true);
    const auto cellTypes = &Look::cellTypes;
    setting({"hidden", "", "hidden"}, &Set::hidden, at(look, cellTypes, &scene::CellTypeFilter::hidden),
            CheckedByApplySet{}, by_another_object);
    setting({"faded", "", "faded"}, &Set::faded, at(look, cellTypes, &scene::CellTypeFilter::faded),
            CheckedByApplySet{}, by_another_object);
    setting({"highlight", "", "highlight"}, &Set::highlight, at(look, &Look::highlight), CheckedByApplySet{},
            by_another_object);

    for (std::size_t i = 0; i < scene::kParts.size(); ++i) {
        const auto& [name, flag] = scene::kParts[i];
        visit(Setting{SettingName{name, "shown", name}, [i](auto& set) -> auto& { return set.parts[i]; },
                      at(look, &Look::parts, flag), AcceptsAnyValue{}, never, false});
    }
}

}  // namespace oval4d::session
