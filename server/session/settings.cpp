#include "session/settings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "session/cell_types.hpp"
#include "session/object_lookup.hpp"
#include "text/message_text.hpp"

namespace oval4d::session {

namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;

struct Bounds {
    double least, most;
    std::string_view unit;
};

// Stores `value`, if there is one, in `into`. Error: `out_of_range`.
Result<std::monostate> put(std::string_view name, std::optional<double> value, Bounds range, double& into) {
    if (!value) return std::monostate{};
    if (!(*value >= range.least && *value <= range.most)) {
        return Error{ErrorCode::out_of_range, std::string(name) + " must be from " +
                                                  text::shortestDecimal(range.least) + " to " +
                                                  text::shortestDecimal(range.most) + std::string(range.unit) +
                                                  ", not " + text::shortestDecimal(*value)};
    }
    into = *value;
    return std::monostate{};
}

void put(std::optional<bool> value, bool& into) { into = value.value_or(into); }

Result<std::monostate> setSlices(State& state, const Set& set, const Limits& limits) {
    if (set.count) {
        if (*set.count < 1 || *set.count > limits.maxSlices || *set.count % 2 == 0) {
            return Error{ErrorCode::out_of_range, "the number of slices must be odd and from 1 to " +
                                                      std::to_string(limits.maxSlices) + ", not " +
                                                      std::to_string(*set.count)};
        }
        setCount(state, *set.count);
    }
    const double radius = slicing::infoOf(state.object).circumradius;
    if (auto done =
            put("the spacing", set.spacing, {kMinSpacing * radius, kMaxSpacing * radius, ""}, state.slices.spacing);
        !done) {
        return done;
    }
    if (set.focus) {
        if (*set.focus < -kMaxFocus || *set.focus > kMaxFocus) {
            return Error{ErrorCode::out_of_range, "the focus must be from -" + std::to_string(kMaxFocus) + " to " +
                                                      std::to_string(kMaxFocus) + ", not " +
                                                      std::to_string(*set.focus)};
        }
        state.slices.focus = *set.focus;
    }
    if (set.focusPoint) {
        // `focus`, `offset` and `focusW` say more than w of the point, which then may be any number.
        const bool placed = set.focus || set.offset || set.focusW;
        glm::dvec4 point(0);
        for (int axis = 0; axis < (placed ? 3 : 4); ++axis) {
            const std::string name = std::string("the point's ") + "xyzw"[axis];
            if (auto done =
                    put(name, (*set.focusPoint)[axis], {-kMaxOffset * radius, kMaxOffset * radius, ""}, point[axis]);
                !done) {
                return done;
            }
        }
        state.look.focusPoint = glm::dvec3(point);
        if (!placed) moveFocusTo(state, point.w);
    }
    if (set.focusW) {
        double w = 0;
        if (auto done = put("w", set.focusW, {-kMaxOffset * radius, kMaxOffset * radius, ""}, w); !done) return done;
        moveFocusTo(state, w);
    }
    return put("the offset", set.offset, {-kMaxOffset * radius, kMaxOffset * radius, ""}, state.slices.offset);
}

// Error: `out_of_range` if the object has no such element.
Result<std::monostate> checkElement(const slicing::Object& object, const slicing::Element& element) {
    const std::size_t count = slicing::elementCount(object, element.kind);
    if (element.index < count) return std::monostate{};
    const std::string kind(text::nameOf(slicing::kElementKinds, element.kind));
    const std::string& name = slicing::infoOf(object).name;
    if (count == 0) return Error{ErrorCode::out_of_range, "the " + name + " has no " + kind};
    return Error{ErrorCode::out_of_range, "the number of the " + kind + " must be from 0 to " +
                                              std::to_string(count - 1) + " for the " + name + ", not " +
                                              std::to_string(element.index)};
}

}  // namespace

void replaceObject(State& state, slicing::Object object) {
    if (object == state.object) return;
    const double radius = slicing::infoOf(object).circumradius;
    const double spacing = state.slices.spacing * (radius / slicing::infoOf(state.object).circumradius);
    state.slices.spacing =
        std::clamp(spacing, kMinSpacing * radius, kMaxSpacing * radius);  // rounding may exceed the bounds
    state.slices.focus = 0;
    state.slices.offset = 0;
    state.ongoingTurnToward.reset();
    state.look.cellTypes = {};
    state.look.highlight.reset();
    state.look.focusPoint = glm::dvec3(0);
    state.object = std::move(object);
}

void setCount(State& state, int count) {
    if (count > 1 && state.slices.count > 1) {
        const double spacing = state.slices.spacing * (state.slices.count - 1) / (count - 1);
        const double radius = slicing::infoOf(state.object).circumradius;
        state.slices.spacing = std::clamp(spacing, kMinSpacing * radius, kMaxSpacing * radius);
    }
    state.slices.count = count;
}

Result<std::monostate> applySet(State& state, const Set& set, const LoadedObjects& loaded, const Limits& limits,
                                ObjectLoader& loader) {
    if (set.object) {
        auto object = findObject(*set.object, loaded, limits, loader);
        if (!object) return object.error();
        replaceObject(state, std::move(*object));
    }
    if (set.orientation && *set.orientation != state.orientation.matrix()) {
        const auto orientation = geometry::Rotation::fromMatrix(*set.orientation);
        if (!orientation) {
            return Error{ErrorCode::not_a_rotation,
                         "the orientation must be an orthogonal 4×4 matrix with determinant 1, to within 1e-6"};
        }
        state.orientation = *orientation;
        state.ongoingTurnToward.reset();
    }
    if (set.lastTurn) {
        if (auto valid = checkTurn(*set.lastTurn); !valid) return valid;
        state.lastTurn = set.lastTurn;
    }
    constexpr double kLeastStep = 1e-9;
    for (auto&& done :
         {put("alpha", set.alpha, {-kTwoPi, kTwoPi, " radians"}, state.alpha),
          put("beta", set.beta, {-kTwoPi, kTwoPi, " radians"}, state.beta),
          put("the step", set.step, {kLeastStep, kTwoPi, " radians"}, state.step), setSlices(state, set, limits),
          put("the camera's azimuth", set.azimuth, {-kMaxOrbitAngle, kMaxOrbitAngle, " radians"},
              state.look.orbit.azimuth),
          put("the camera's elevation", set.elevation, {-kMaxOrbitAngle, kMaxOrbitAngle, " radians"},
              state.look.orbit.elevation),
          put("the camera's zoom", set.zoom, {kMinZoom, kMaxZoom, ""}, state.look.orbit.zoom),
          put("the eye", set.eye, {kMinEye, kMaxEye, " circumradii"}, state.look.projection.eye)}) {
        if (!done) return done;
    }
    state.look.view = set.view.value_or(state.look.view);
    for (std::size_t i = 0; i < scene::kParts.size(); ++i) put(set.parts[i], state.look.parts.*scene::kParts[i].flag);
    state.look.projection.kind = set.projection.value_or(state.look.projection.kind);
    state.look.coloring = set.coloring.value_or(state.look.coloring);
    if (auto done = setCellTypeVisibility(state, set); !done) return done;
    if (set.highlight) {
        if (*set.highlight) {
            if (auto valid = checkElement(state.object, **set.highlight); !valid) return valid;
        }
        state.look.highlight = *set.highlight;
    }
    put(set.turning, state.turning);
    if (set.turning) state.ongoingTurnToward.reset();
    if (state.turning && !state.lastTurn) {
        return Error{ErrorCode::nothing_to_undo, "nothing to repeat: no rotation has been made yet"};
    }
    return std::monostate{};
}

Result<std::monostate> checkTurn(const geometry::Turn& turn) {
    for (const double angle : {turn.alpha, turn.beta.value_or(0)}) {
        if (!(std::abs(angle) <= kMaxAngle)) {
            return Error{ErrorCode::out_of_range, "an angle must be from " + text::shortestDecimal(-kMaxAngle) +
                                                      " to " + text::shortestDecimal(kMaxAngle) + " radians, not " +
                                                      text::shortestDecimal(angle)};
        }
    }
    return std::monostate{};
}

void rotate(State& state, const geometry::Turn& turn) {
    state.orientation = geometry::Rotation(turn) * state.orientation;
    state.lastTurn = turn;
    state.ongoingTurnToward.reset();
}

Result<std::monostate> turnToward(State& state, const TurnToward& command) {
    if (auto valid = checkElement(state.object, {command.kind, command.index.value_or(0)}); !valid) return valid;
    const slicing::Element element = command.index
                                         ? slicing::Element{command.kind, *command.index}
                                         : *slicing::elementToTurnTo(state.object, command.kind, state.orientation);
    const glm::dvec4 w(0, 0, 0, 1);
    const glm::dvec4 own = slicing::directionOf(state.object, element, state.orientation.inverse()(w));
    const geometry::Rotation way = geometry::Rotation::between(state.orientation(own), w);
    const geometry::Rotation goal = way * state.orientation;
    state.turning = false;
    state.ongoingTurnToward.reset();
    constexpr double kRadiansPerSecond = std::numbers::pi / 2;
    const double seconds = way.angle() / kRadiansPerSecond;
    constexpr double kShortest = 1e-3;  // a turn that takes less time is not seen
    if (command.immediately || seconds < kShortest) {
        state.orientation = goal;
    } else {
        state.ongoingTurnToward = OngoingTurnToward{goal, seconds};
    }
    return std::monostate{};
}

void moveFocusTo(State& state, double w) {
    const double spacing = state.slices.spacing;
    const double limit = kMaxFocus;  // a spacing far below the circumradius cannot reach every w
    state.slices.focus = static_cast<int>(std::clamp(std::round(w / spacing), -limit, limit));
    state.slices.offset = w - state.slices.focus * spacing;
}

void moveFocusToVertex(State& state, bool upward) {
    const auto height = slicing::nextVertexHeight(state.object, state.orientation, state.focusW(), upward);
    if (height) moveFocusTo(state, *height);
}

}  // namespace oval4d::session
