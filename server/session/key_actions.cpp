#include "session/key_actions.hpp"

#include <algorithm>
#include <cmath>
#include <ranges>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "session/history.hpp"
#include "session/object_lookup.hpp"
#include "session/setting_table.hpp"
#include "session/settings.hpp"
#include "slicing/slicer.hpp"
#include "text/choice.hpp"

namespace oval4d::session {

namespace {

using VoidResult = Result<std::monostate>;

constexpr double kSpacingFactor = 1.1;

void moveFocusToSlice(State& state, int to) {
    state.slices.focus = std::clamp(to, -kMaxFocus, kMaxFocus);
    state.playing = false;
}

// Returns the indices n (see HyperplaneSettings) of the first and the last hyperplane that intersect the object. For a
// point cloud, whose slices are thick, returns the indices of the hyperplanes nearest to the points with the least and
// the greatest w.
std::pair<int, int> firstAndLastNonemptySlice(const State& state) {
    const auto [least, most] = slicing::rangeOfW(state.object, state.orientation);
    const double slack = slicing::kOnPlaneTolerance * slicing::infoOf(state.object).circumradius;
    const auto [count, spacing, focus, offset] = state.slices;
    if (slicing::propertiesOf(state.object).slicesAreThick) {
        // A point half way between two hyperplanes belongs to the upper hyperplane, as in CloudSlicer, which makes the
        // slices.
        return {static_cast<int>(std::floor((least - offset) / spacing + 0.5)),
                static_cast<int>(std::floor((most - offset) / spacing + 0.5))};
    }
    return {static_cast<int>(std::ceil((least - slack - offset) / spacing)),
            static_cast<int>(std::floor((most + slack - offset) / spacing))};
}

// Moves the focus point by the spacing along `axis` (0, 1 or 2 for x, y or z), upward or downward, but not beyond its
// bounds.
void moveFocusPoint(State& state, int axis, bool up) {
    const double reach = kMaxOffset * slicing::infoOf(state.object).circumradius;
    double& coordinate = state.look.focusPoint[axis];
    coordinate = std::clamp(coordinate + (up ? state.slices.spacing : -state.slices.spacing), -reach, reach);
}

void scaleSpacing(State& state, double factor) {
    const double radius = slicing::infoOf(state.object).circumradius;
    state.slices.spacing = std::clamp(state.slices.spacing * factor, kMinSpacing * radius, kMaxSpacing * radius);
}

VoidResult showNeighborObject(ActionContext& c, int by) {
    auto object = neighborInObjectList(c.state.source, by, c.loaded, c.loader);
    if (!object) return object.error();
    return replaceObject(c.state, std::move(*object), c.loader);
}

const Error kNoRotationYet{ErrorCode::nothing_to_undo,
                           "nothing to repeat: no rotation has been made yet; 2 … 7, r, t and y make one"};

// Shows a view, or the oval if the view is already shown.
void toggleView(State& state, scene::View view) {
    state.look.view = state.look.view == view ? scene::View::oval : view;
}

// Calls `act`, an action that cannot fail, and returns success.
template <auto act>
VoidResult succeedAfter(ActionContext& c) {
    act(c);
    return std::monostate{};
}

// Returns the value after `value` in its table of choices. After the last value comes the first.
template <text::HasChoices Value>
Value nextChoice(Value value) {
    const auto& choices = choicesOf(value);
    auto at = std::ranges::find(choices, value, &std::ranges::range_value_t<decltype(choices)>::value);
    while (at != choices.end() && at->value == value) ++at;  // further rows with the same value are its aliases
    return at == choices.end() ? choices.begin()->value : at->value;
}

// Returns the actions with code of their own. allActions() makes all others in loops over tables.
std::vector<KeyAction> individualActions() {
    return {
        {"rotate", succeedAfter<[](ActionContext& c) {
             const geometry::RotationAngles turn(c.plane, c.state.alpha,
                                                 c.isDoubleRotation ? std::optional(c.state.beta) : std::nullopt);
             rotate(c.state, c.inverse ? turn.inverse() : turn);
         }>},
        {"repeat",
         [](ActionContext& c) -> VoidResult {
             if (!c.state.lastTurn) return kNoRotationYet;
             rotate(c.state, *c.state.lastTurn);
             return std::monostate{};
         }},
        {"turn",
         [](ActionContext& c) -> VoidResult {
             if (!c.state.lastTurn) return kNoRotationYet;
             c.state.turning = !c.state.turning;
             c.state.ongoingTurnToward.reset();
             return std::monostate{};
         }},
        {"play", succeedAfter<[](ActionContext& c) { c.state.playing = !c.state.playing; }>},
        {"focus_right", succeedAfter<[](ActionContext& c) { moveFocusToSlice(c.state, c.state.slices.focus + 1); }>},
        {"focus_left", succeedAfter<[](ActionContext& c) { moveFocusToSlice(c.state, c.state.slices.focus - 1); }>},
        {"focus_zero", succeedAfter<[](ActionContext& c) {
             moveFocusToSlice(c.state, 0);
             c.state.slices.offset = 0;
         }>},
        {"focus_first",
         succeedAfter<[](ActionContext& c) { moveFocusToSlice(c.state, firstAndLastNonemptySlice(c.state).first); }>},
        {"focus_last",
         succeedAfter<[](ActionContext& c) { moveFocusToSlice(c.state, firstAndLastNonemptySlice(c.state).second); }>},
        {"vertex_next", [](ActionContext& c) { return moveFocusToNextCritical(c.state, true, c.loader); }, nullptr,
         true},
        {"vertex_previous", [](ActionContext& c) { return moveFocusToNextCritical(c.state, false, c.loader); }, nullptr,
         true},
        {"spacing_smaller", succeedAfter<[](ActionContext& c) { scaleSpacing(c.state, 1 / kSpacingFactor); }>},
        {"spacing_larger", succeedAfter<[](ActionContext& c) { scaleSpacing(c.state, kSpacingFactor); }>},
        {"slices_fewer",
         succeedAfter<[](ActionContext& c) { setSliceCount(c.state, std::max(c.state.slices.count - 2, 1)); }>},
        {"slices_more", succeedAfter<[](ActionContext& c) {
             if (c.state.slices.count + 2 <= c.limits.maxSlices) setSliceCount(c.state, c.state.slices.count + 2);
         }>},
        {"polytope_next", [](ActionContext& c) { return showNeighborObject(c, 1); }, nullptr, true},
        {"polytope_previous", [](ActionContext& c) { return showNeighborObject(c, -1); }, nullptr, true},
        {"view", succeedAfter<[](ActionContext& c) { toggleView(c.state, scene::View::single); }>},
        {"undo", nullptr, undo},
        {"redo", nullptr, redo},
    };
}

// Adds to `actions` those that increase and decrease the number of a setting by a step (see KeyStepSize); none if no
// keys change it.
template <typename Row>
void addStepActions(const Row& setting, std::vector<KeyAction>& actions) {
    const auto add = [&](const std::string& ending, auto next) {
        actions.push_back({std::string(setting.name.text) + ending, [setting, next](ActionContext& c) -> VoidResult {
                               double& value = setting.ofState(c.state);
                               const auto& [least, most] = setting.rule.range;
                               value = std::clamp(next(value, c.state), least, most);
                               return std::monostate{};
                           }});
    };
    if (const int perDoubling = setting.rule.keys.perDoubling; perDoubling > 0) {
        const auto step = [perDoubling](double value, int by) {
            return std::exp2((std::round(perDoubling * std::log2(value)) + by) / perDoubling);
        };
        add("_larger", [step](double value, const State&) { return step(value, 1); });
        add("_smaller", [step](double value, const State&) { return step(value, -1); });
    }
    if (const auto amount = setting.rule.keys.amount; amount != nullptr) {
        add("_up", [amount](double value, const State& state) { return value + state.*amount; });
        add("_down", [amount](double value, const State& state) { return value - state.*amount; });
    }
}

std::vector<KeyAction> allActions() {
    std::vector<KeyAction> actions = individualActions();
    for (const scene::NamedPicturePart& part : scene::kParts) {
        actions.push_back({std::string(part.name), [flag = part.flag](ActionContext& c) -> VoidResult {
                               bool& isShown = c.state.look.parts.*flag;
                               isShown = !isShown;
                               return std::monostate{};
                           }});
    }
    for (const auto& [name, kind] : slicing::kElementKinds) {
        actions.push_back(
            {"toward_" + std::string(name), [of = kind](ActionContext& c) { return turnToward(c.state, {of, {}}); }});
        for (const bool forward : {true, false}) {
            actions.push_back(
                {(forward ? "highlight_next_" : "highlight_previous_") + std::string(name),
                 [of = kind, forward](ActionContext& c) { return highlightNeighbor(c.state, of, forward); }});
        }
    }
    for (int axis = 0; axis < 3; ++axis) {
        for (const bool up : {true, false}) {
            actions.push_back({std::string("point_") + "xyz"[axis] + (up ? "_up" : "_down"),
                               [axis, up](ActionContext& c) -> VoidResult {
                                   moveFocusPoint(c.state, axis, up);
                                   return std::monostate{};
                               }});
        }
    }
    for (const scene::ViewTableRow& row : scene::kViews) {
        // The view `oval` has no action of its own, because the actions of all other views lead back to it. The action
        // "view" of individualActions() toggles the view `single`.
        if (row.value == scene::View::oval || row.value == scene::View::single) continue;
        actions.push_back({std::string(row.name), [to = row.value](ActionContext& c) -> VoidResult {
                               toggleView(c.state, to);
                               return std::monostate{};
                           }});
    }
    forEachSetting([&]<typename Row>(const Row& setting) {
        if constexpr (Row::kHasRange) addStepActions(setting, actions);
        if constexpr (Row::kIsInState) {
            using SettingValueType = std::remove_cvref_t<decltype(setting.ofState(std::declval<State&>()))>;
            if constexpr (text::HasChoices<SettingValueType> && !std::is_same_v<SettingValueType, scene::View>) {
                actions.push_back({std::string(setting.name.text), [setting](ActionContext& c) -> VoidResult {
                                       ChangeSettings set;
                                       setting.ofSet(set) = nextChoice(setting.ofState(c.state));
                                       return applySet(c.state, set, c.loaded, c.limits, c.loader);
                                   }});
            }
        }
    });
    return actions;
}

}  // namespace

std::span<const KeyAction> keyActions() {
    static const std::vector<KeyAction> actions = allActions();
    return actions;
}

}  // namespace oval4d::session
