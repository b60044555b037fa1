#pragma once
// The undo history of a session.

#include "session/session.hpp"

namespace oval4d::session {

/// Makes `next` the current state and increases the revision; does nothing if `next` equals the current state. Adds a
/// history step, and clears what redo could restore, unless only the camera has moved or continuous turning has
/// stopped.
void commit(Session& session, State next, const Limits& limits);

/// Removes the older half of the steps that can be undone.
void forgetOldest(Session& session);

/// Undoes or redoes one step. The camera stays where it is. Error: `nothing_to_undo`.
Result<std::monostate> undo(Session& session);
Result<std::monostate> redo(Session& session);

}  // namespace oval4d::session
