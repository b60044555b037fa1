#pragma once
// The actions that keys trigger: functions that change a session.

#include <functional>
#include <span>
#include <string>

#include "geometry/rotation.hpp"
#include "session/session.hpp"

namespace oval4d::session {

/// The arguments of an action.
struct ActionContext {
    State& state;
    const LoadedObjects& loaded;
    const Limits& limits;
    ObjectLoader& loader;
    geometry::Plane plane;  ///< the plane of the rotation by alpha
    bool isDoubleRotation;  ///< whether to rotate also by beta in the perpendicular plane
    bool inverse;           ///< whether to apply the inverse rotation
};

/// An action. Exactly one of the functions is set. `onState` changes a copy of the current state, which the caller then
/// commits to the session, or discards if `onState` returns an error. `onSession` changes the session itself.
struct Action {
    std::string name;  ///< the value of "action" in protocol/keymap.json
    std::function<Result<std::monostate>(ActionContext&)> onState = nullptr;
    std::function<Result<std::monostate>(Session&)> onSession = nullptr;
    bool mayNeedLoading = false;  ///< whether `onState` may use ActionContext::loader
};

/// Returns all actions that the server performs:
/// - those of the table in key_actions.cpp;
/// - for each row of scene::kParts, one that toggles this part of the picture;
/// - for each row of slicing::kElementKinds, one that turns an element of this kind toward +w, and two that highlight
///   the next and the previous element of this kind;
/// - for each view but the oval, one that toggles the view;
/// - for each other setting that is an enumeration, one that has the name of the setting and sets it to its next value;
/// - for each setting with KeySteps, two that step to a larger and to a smaller number.
std::span<const Action> keyActions();

}  // namespace oval4d::session
