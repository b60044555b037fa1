#pragma once
// The actions of the keys on a state.

#include "session/keymap.hpp"
#include "session/settings.hpp"

namespace oval4d::session {

/// Carries out every action but undo and redo. On an error `state` is unchanged.
protocol::Result<std::monostate> act(State& state, const Binding& binding, const Loaded& loaded, const Limits& limits,
                                     Workshop& workshop);

}  // namespace oval4d::session
