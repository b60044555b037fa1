#pragma once
// The undo history of a session.

#include "session/session.hpp"

namespace oval4d::session {

// The undo steps are earlier states of the session. The redo steps are the states from which undo went back. A step may
// equal the current state apart from the camera, for example when a motion ends where it began. Undo and redo skip such
// a step, and a new step replaces it.
//
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
/// steps until the undo steps are within Limits::maxUndo and Limits::maxUndoBytes.
void commitUndoStep(Session& session, State next, const Limits& limits);

/// Makes `next` the current state, as a part of the last undo step: undo then returns to the state before that step. If
/// there is no undo step, or if there are redo steps, works like commitUndoStep().
void amendUndoStep(Session& session, State next, const Limits& limits);

/// Returns the state before the undo step that amendUndoStep() would extend. Returns null if amendUndoStep() would do
/// the same as commitUndoStep().
const State* stateBeforeAmendableStep(const Session& session);

/// Removes the older half of the undo steps to free memory.
void forgetOlderUndoSteps(Session& session);

/// undo() undoes one step, and redo() redoes one. Both leave the camera where it is. Error: `nothing_to_undo` if there
/// is no step that differs from the current state in more than the camera.
Result<std::monostate> undo(Session& session);
Result<std::monostate> redo(Session& session);

}  // namespace oval4d::session
