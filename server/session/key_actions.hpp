#pragma once
// The actions of the keys: functions that change a session.

#include <span>
#include <string_view>

#include "geometry/rotation.hpp"
#include "session/session.hpp"

namespace oval4d::session {

/// The arguments of an action.
struct ActionContext {
    State& state;
    const Loaded& loaded;
    const Limits& limits;
    ObjectLoader& loader;
    geometry::Plane plane;  ///< the plane of a rotation by alpha
    bool doubled;           ///< also rotate by beta in the perpendicular plane
    bool inverse;           ///< apply the inverse rotation
};

/// One action. Exactly one of the functions is set; after an error, the caller must discard the state that `onState`
/// was given.
struct Action {
    std::string_view name;  ///< the value of "action" in protocol/keymap.json
    Result<std::monostate> (*onState)(ActionContext&) = nullptr;
    Result<std::monostate> (*onSession)(Session&) = nullptr;
};

/// All actions that the server performs: those of the table in key_actions.cpp, and one for each row of scene::kParts,
/// which toggles that part of the picture.
std::span<const Action> keyActions();

}  // namespace oval4d::session
