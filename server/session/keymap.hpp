#pragma once
// The table of keys and their actions, from protocol/keymap.json.

#include <optional>
#include <string>
#include <string_view>

#include "errors/error.hpp"
#include "session/command.hpp"
#include "session/key_actions.hpp"

namespace oval4d::session {

/// The action that a key triggers, and the action's arguments.
struct KeyBinding {
    const KeyAction* action = nullptr;
    geometry::Plane plane = geometry::Plane::xy;
    bool isDoubleRotation = false;  ///< whether to rotate also by the angle beta, in the perpendicular plane
    bool inverse = false;           ///< whether to turn in the opposite direction
};

/// Returns the action of a key, or an empty optional if the key begins a sequence of two keys. `pending` is the first
/// key of a sequence in progress; empty if there is none. The function updates `pending`: the first g of "gg" sets it
/// to "g", and a key with an action clears it. A key that does not continue the sequence acts as if no sequence had
/// begun. Error: `unknown_key`, also for keys that only the client handles; `pending` is then unchanged.
Result<std::optional<KeyBinding>> bindingOf(const KeyPress& key, std::string& pending);

}  // namespace oval4d::session
