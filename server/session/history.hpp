#pragma once
// The undo history of a session.

#include "session/session.hpp"

namespace oval4d::session {

/// Makes `next` the current state and increases the revision. Adds an undo step and removes all redo steps, unless
/// `next` differs only by a camera move or by the end of continuous turning. Then removes the oldest undo steps until
/// the history is within `limits`. Does nothing if `next` equals the current state.
void commit(Session& session, State next, const Limits& limits);

/// Like commit(), but `next` becomes a part of the last undo step: undo returns to the state before that step. If there
/// is no undo step, or if the last command was an undo, adds a new undo step instead.
void amend(Session& session, State next, const Limits& limits);

/// Removes the older half of the undo steps, to free memory.
void forgetOlderHalf(Session& session);

/// Undoes or redoes one step. Does not move the camera. Error: `nothing_to_undo` if there is no such step.
Result<std::monostate> undo(Session& session);
Result<std::monostate> redo(Session& session);

}  // namespace oval4d::session
