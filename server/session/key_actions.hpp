#pragma once
// The actions that keys trigger: functions that change a session.

#include <span>
#include <string_view>

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
    std::string_view name;  ///< the value of "action" in protocol/keymap.json
    Result<std::monostate> (*onState)(ActionContext&) = nullptr;
    Result<std::monostate> (*onSession)(Session&) = nullptr;
};

/// Returns all actions that the server performs: those of the table in key_actions.cpp; for each row of scene::kParts,
/// one that toggles this part of the picture; and for each row of slicing::kElementKinds, one that turns an element of
/// this kind toward +w.
std::span<const Action> keyActions();

}  // namespace oval4d::session
