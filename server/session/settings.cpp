#include "session/settings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "geometry/catalogue.hpp"
#include "protocol/cpp/suggest.hpp"
#include "session/kinds.hpp"

namespace oval4d::session {

namespace {

using protocol::Error;
using protocol::ErrorCode;
using protocol::Result;
using protocol::shortest;

constexpr double kTwoPi = 2 * std::numbers::pi;

struct Range {
    double least, most;
    std::string_view unit;
};

// A value into its place, if it lies within its bounds.
Result<std::monostate> put(std::string_view name, std::optional<double> value, Range range, double& into) {
    if (!value) return std::monostate{};
    if (!(*value >= range.least && *value <= range.most)) {
        return Error{ErrorCode::out_of_range, std::string(name) + " must be from " + shortest(range.least) + " to " +
                                                  shortest(range.most) + std::string(range.unit) + ", not " +
                                                  shortest(*value)};
    }
    into = *value;
    return std::monostate{};
}

void put(std::optional<bool> value, bool& into) { into = value.value_or(into); }

Result<std::monostate> setSlices(State& state, const protocol::Set& set, const Limits& limits) {
    if (set.count) {
        if (*set.count < 1 || *set.count > limits.maxSlices || *set.count % 2 == 0) {
            return Error{ErrorCode::out_of_range, "the number of slices must be odd and from 1 to " +
                                                      std::to_string(limits.maxSlices) + ", not " +
                                                      std::to_string(*set.count)};
        }
        setCount(state, *set.count);
    }
    const double radius = state.polytope->circumradius;
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
    return std::monostate{};
}

// "; did you mean …?": the names of the catalogue nearest to this one, or a loaded polytope's if that is as near.
std::string suggestion(std::string_view name, const Loaded& loaded) {
    std::vector<std::string_view> near = geometry::nearestNames(name);
    std::size_t least = geometry::likeness(name, near.front());
    for (const auto& [own, ignored] : loaded) {
        if (geometry::likeness(name, own) > least) continue;
        least = geometry::likeness(name, own);
        near = {own};
    }
    std::string text;
    for (std::size_t i = 0; i < near.size(); ++i) {
        text += i == 0 ? "; did you mean " : i + 1 < near.size() ? ", " : " or ";
        text += protocol::inQuotes(near[i]);
    }
    return text + "?";
}

}  // namespace

Result<PolytopePtr> findPolytope(std::string_view name, const Loaded& loaded, const Limits& limits,
                                 Workshop& workshop) {
    if (const auto own = loaded.find(name); own != loaded.end()) return own->second;
    auto named = geometry::designNamed(name, limits.maxVertices);
    if (const auto* design = std::get_if<geometry::Design>(&named)) {
        auto polytope = workshop.polytope(*design);
        if (polytope || polytope.error().code != ErrorCode::unknown_polytope) return polytope;
        named = geometry::NameError{geometry::NameError::Reason::impossible, polytope.error().message};
    }
    const auto& error = std::get<geometry::NameError>(named);
    if (error.reason == geometry::NameError::Reason::too_large) return Error{ErrorCode::too_large, error.message};
    return Error{ErrorCode::unknown_polytope,
                 "no polytope is called " + protocol::inQuotes(name) +
                     (error.message.empty() ? suggestion(name, loaded) : ": " + error.message)};
}

void show(State& state, PolytopePtr polytope) {
    if (polytope == state.polytope) return;
    state.slices.spacing *= polytope->circumradius / state.polytope->circumradius;
    state.slices.focus = 0;
    state.look.kinds = {};
    state.polytope = std::move(polytope);
}

void setCount(State& state, int count) {
    if (count > 1 && state.slices.count > 1) {
        const double spacing = state.slices.spacing * (state.slices.count - 1) / (count - 1);
        const double radius = state.polytope->circumradius;
        state.slices.spacing = std::clamp(spacing, kMinSpacing * radius, kMaxSpacing * radius);
    }
    state.slices.count = count;
}

Result<std::monostate> applySet(State& state, const protocol::Set& set, const Loaded& loaded, const Limits& limits,
                                Workshop& workshop) {
    if (set.polytope) {
        auto polytope = findPolytope(*set.polytope, loaded, limits, workshop);
        if (!polytope) return polytope.error();
        show(state, std::move(*polytope));
    }
    if (set.orientation && *set.orientation != state.orientation.matrix()) {
        const auto orientation = geometry::Rotation::fromMatrix(*set.orientation);
        if (!orientation) {
            return Error{ErrorCode::not_a_rotation,
                         "the orientation must be an orthogonal 4×4 matrix with determinant 1, to within 1e-6"};
        }
        state.orientation = *orientation;
    }
    if (set.last) {
        if (auto sound = checkTurn(*set.last); !sound) return sound;
        state.last = set.last;
    }
    constexpr double kLeastStep = 1e-9;
    for (auto&& done :
         {put("alpha", set.alpha, {-kTwoPi, kTwoPi, " radians"}, state.alpha),
          put("beta", set.beta, {-kTwoPi, kTwoPi, " radians"}, state.beta),
          put("the step", set.step, {kLeastStep, kTwoPi, " radians"}, state.step), setSlices(state, set, limits),
          put("the camera's azimuth", set.azimuth, {-kMaxOrbit, kMaxOrbit, " radians"}, state.look.orbit.azimuth),
          put("the camera's elevation", set.elevation, {-kMaxOrbit, kMaxOrbit, " radians"}, state.look.orbit.elevation),
          put("the camera's zoom", set.zoom, {kMinZoom, kMaxZoom, ""}, state.look.orbit.zoom)}) {
        if (!done) return done;
    }
    state.look.view = set.view.value_or(state.look.view);
    put(set.faces, state.look.parts.faces);
    put(set.bars, state.look.parts.bars);
    put(set.balls, state.look.parts.balls);
    put(set.coordinates, state.look.parts.coordinates);
    state.look.colouring = set.colouring.value_or(state.look.colouring);
    if (auto done = setKinds(state, set); !done) return done;
    put(set.turning, state.turning);
    if (state.turning && !state.last) {
        return Error{ErrorCode::nothing_to_undo, "nothing to turn with: no rotation has been made yet"};
    }
    return std::monostate{};
}

Result<std::monostate> checkTurn(const geometry::Turn& turn) {
    for (const double angle : {turn.alpha, turn.beta.value_or(0)}) {
        if (!(std::abs(angle) <= kMaxAngle)) {
            return Error{ErrorCode::out_of_range, "an angle must be from " + shortest(-kMaxAngle) + " to " +
                                                      shortest(kMaxAngle) + " radians, not " + shortest(angle)};
        }
    }
    return std::monostate{};
}

void rotate(State& state, const geometry::Turn& turn) {
    state.orientation = geometry::Rotation(turn) * state.orientation;
    state.last = turn;
}

}  // namespace oval4d::session
