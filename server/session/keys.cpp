#include "session/keys.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "geometry/catalogue.hpp"
#include "geometry/slicer.hpp"

namespace oval4d::session {

namespace {

using protocol::Error;
using protocol::ErrorCode;
using protocol::Result;

constexpr double kSpacingFactor = 1.1;

void turnBy(State& state, const Binding& binding) {
    geometry::Turn turn{binding.plane, state.alpha, {}};
    if (binding.doubled) turn.beta = state.beta;
    rotate(state, binding.inverse ? turn.inverse() : turn);
}

void stepAngle(double& angle, double step) {
    angle = std::clamp(angle + step, -2 * std::numbers::pi, 2 * std::numbers::pi);
}

void moveFocus(State& state, int to) { state.slices.focus = std::clamp(to, -kMaxFocus, kMaxFocus); }

// The indices of the hyperplanes that meet the polytope.
std::pair<int, int> filledSlices(const State& state) {
    const glm::dmat4 matrix = state.orientation.matrix();
    double least = 0;
    double most = 0;
    for (const glm::dvec4& v : state.polytope->vertices) {
        const double w = matrix[0][3] * v.x + matrix[1][3] * v.y + matrix[2][3] * v.z + matrix[3][3] * v.w;
        const bool first = &v == state.polytope->vertices.data();
        least = first ? w : std::min(least, w);
        most = first ? w : std::max(most, w);
    }
    const double slack = geometry::Slicer::kOnPlane * state.polytope->circumradius;
    const double spacing = state.slices.spacing;
    return {static_cast<int>(std::ceil((least - slack) / spacing)),
            static_cast<int>(std::floor((most + slack) / spacing))};
}

void scaleSpacing(State& state, double factor) {
    const double radius = state.polytope->circumradius;
    state.slices.spacing = std::clamp(state.slices.spacing * factor, kMinSpacing * radius, kMaxSpacing * radius);
}

// The catalogue, then the loaded ones by name, round and round.
Result<std::monostate> walk(State& state, int by, const Loaded& loaded, Workshop& workshop) {
    std::vector<PolytopePtr> own;
    for (const auto& [name, polytope] : loaded) own.push_back(polytope);
    const auto entries = geometry::catalogue();
    const int named = static_cast<int>(entries.size());
    const int all = named + static_cast<int>(own.size());
    const auto at = std::find(own.begin(), own.end(), state.polytope);
    const auto entry = std::find_if(entries.begin(), entries.end(), [&](const geometry::CatalogueEntry& one) {
        return one.name == state.polytope->name;
    });
    int i = 0;
    if (at != own.end()) {
        i = named + static_cast<int>(at - own.begin());
    } else if (entry != entries.end()) {
        i = static_cast<int>(entry - entries.begin());
    } else {
        i = by > 0 ? -1 : named;  // one built by its name alone: before the first, after the last
    }
    i = (i + by + all) % all;
    auto polytope = i < named ? workshop.polytope(entries[i].design) : Result<PolytopePtr>(own[i - named]);
    if (!polytope) return polytope.error();
    show(state, std::move(*polytope));
    return std::monostate{};
}

Error noRotationYet() {
    return {ErrorCode::nothing_to_undo, "nothing to repeat: no rotation has been made yet; 2 … 7, r, t and y make one"};
}

}  // namespace

Result<std::monostate> act(State& state, const Binding& binding, const Loaded& loaded, const Limits& limits,
                           Workshop& workshop) {
    scene::Parts& parts = state.look.parts;
    switch (binding.action) {
        case Action::rotate:
            turnBy(state, binding);
            break;
        case Action::alpha_up:
            stepAngle(state.alpha, state.step);
            break;
        case Action::alpha_down:
            stepAngle(state.alpha, -state.step);
            break;
        case Action::beta_up:
            stepAngle(state.beta, state.step);
            break;
        case Action::beta_down:
            stepAngle(state.beta, -state.step);
            break;
        case Action::focus_right:
            moveFocus(state, state.slices.focus + 1);
            break;
        case Action::focus_left:
            moveFocus(state, state.slices.focus - 1);
            break;
        case Action::focus_zero:
            moveFocus(state, 0);
            break;
        case Action::focus_first:
            moveFocus(state, filledSlices(state).first);
            break;
        case Action::focus_last:
            moveFocus(state, filledSlices(state).second);
            break;
        case Action::repeat:
            if (!state.last) return noRotationYet();
            rotate(state, *state.last);
            break;
        case Action::turn:
            if (!state.last) return noRotationYet();
            state.turning = !state.turning;
            break;
        case Action::spacing_smaller:
            scaleSpacing(state, 1 / kSpacingFactor);
            break;
        case Action::spacing_larger:
            scaleSpacing(state, kSpacingFactor);
            break;
        case Action::slices_fewer:
            setCount(state, std::max(state.slices.count - 2, 1));
            break;
        case Action::slices_more:
            if (state.slices.count + 2 <= limits.maxSlices) setCount(state, state.slices.count + 2);
            break;
        case Action::polytope_next:
            return walk(state, 1, loaded, workshop);
        case Action::polytope_previous:
            return walk(state, -1, loaded, workshop);
        case Action::view:
            state.look.view = state.look.view == scene::View::oval ? scene::View::single : scene::View::oval;
            break;
        case Action::coordinates:
            parts.coordinates = !parts.coordinates;
            break;
        case Action::faces:
            parts.faces = !parts.faces;
            break;
        case Action::bars:
            parts.bars = !parts.bars;
            break;
        case Action::balls:
            parts.balls = !parts.balls;
            break;
        case Action::undo:
        case Action::redo:
            break;  // not actions on a state
    }
    return std::monostate{};
}

}  // namespace oval4d::session
