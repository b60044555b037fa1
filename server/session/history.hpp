#pragma once
// The undo history of a session.

#include "session/session.hpp"

namespace oval4d::session {

// The undo steps are earlier states of the session. The redo steps are states that undo has left. Some steps equal the
// current state apart from the camera, for example when a motion ends where it began. Undo and redo skip such steps,
// and a new step replaces them.
// The functions of this file keep these rules:
//    - A function that changes the current state increases the revision by one. A function that does not change the
//      current state, or returns an error, leaves the whole session unchanged.
//    - Undo, repeated until it fails, leads to the oldest state in the history. This is the first state of the session,
//      unless the limits of the history have removed that state. The same number of redos leads back.
//    - Undo and redo do not move the camera.
//    - Undo followed by redo restores the current state. Redo followed by undo does so, too.

/// Makes `next` the current state and increases the revision. Does nothing if `next` equals the current state. Adds an
/// undo step and removes all redo steps, unless `next` differs only in the camera, or ends continuous turning or
/// playing. If `next` ends playing and has other changes, undo does not resume playing. Finally removes the oldest undo
/// steps until the history is within `limits`.
void commitUndoStep(Session& session, State next, const Limits& limits);

/// Makes `next` the current state, as a part of the last undo step: undo then returns to the state before that step. If
/// there is no undo step, or if there are redo steps, works like commitUndoStep().
void amendUndoStep(Session& session, State next, const Limits& limits);

/// Returns the state before the undo step that amendUndoStep() would extend. Returns null if amendUndoStep() would do
/// the same as commitUndoStep().
const State* stateBeforeAmendableStep(const Session& session);

/// Removes the older half of the undo steps to free memory.
void forgetOlderHalf(Session& session);

/// Undoes or redoes one step, but does not move the camera. Error: `nothing_to_undo` if no step differs from the
/// current state.
Result<std::monostate> undo(Session& session);
Result<std::monostate> redo(Session& session);

}  // namespace oval4d::session
