#pragma once
// The actions that keys trigger: functions that change a session.

#include <functional>
#include <span>
#include <string>

#include "geometry/rotation.hpp"
#include "session/session.hpp"

namespace oval4d::session {

/// The arguments of an action that a key triggers.
struct ActionContext {
    State& state;
    const LoadedObjects& loaded;
    const Limits& limits;
    ObjectLoader& loader;
    geometry::Plane plane;  ///< the plane of the rotation by the angle alpha
    bool isDoubleRotation;  ///< whether to rotate also by the angle beta, in the perpendicular plane
    bool inverse;           ///< whether to turn in the opposite direction
};

/// An action that a key triggers. Exactly one of the two functions is set. `onState` changes a copy of the current
/// state. If it succeeds, the caller commits the copy to the session. `onSession` changes the session itself.
struct KeyAction {
    std::string name;  ///< the value of "action" in protocol/keymap.json
    std::function<Result<std::monostate>(ActionContext&)> onState = nullptr;
    std::function<Result<std::monostate>(Session&)> onSession = nullptr;
    bool mayNeedLoading = false;  ///< whether `onState` may need an object that must be loaded first
};

/// Returns all actions that the server executes:
/// - the actions that individualActions() in key_actions.cpp lists;
/// - for each row of scene::kParts, an action that shows or hides this part of the picture;
/// - for each row of slicing::kElementKinds, an action that turns an element of this kind toward +w, and two actions
///   that highlight the next and the previous element of this kind;
/// - for each of the axes x, y and z, two actions that move the focus point up and down along this axis;
/// - for each view except the oval, an action that toggles between this view and the oval;
/// - for each other setting that is an enumeration, an action with the name of the setting that selects the next
///   value;
/// - for each setting with KeyStepSize, two actions that increase and decrease the number by a step.
std::span<const KeyAction> keyActions();

}  // namespace oval4d::session
