#pragma once
// The undo history of a session.

#include "session/session.hpp"

namespace oval4d::session {

// The undo steps are earlier states of the session, and the redo steps are states that undo has left. A step can equal
// the current state, apart from the camera: when an object starts to turn and is stopped at once, when a gesture or a
// motion ends where it began, and in stored sessions. Undo and redo skip such steps, and a new step replaces them.
// The functions of this file keep these rules:
//   - A function that changes the current state increases the revision by one. A function that does not change it, or
//     returns an error, leaves the whole session as it was.
//   - Undo, repeated until it fails, leads to the oldest state in the history: the first state of the session, unless
//     that was removed to keep the history within its limits. The same number of redos leads back. Undo and redo do not
//     move the camera.
//   - Undo followed by redo restores the current state, and so does redo followed by undo.

/// Makes `next` the current state and increases the revision. Adds an undo step and removes all redo steps, unless
/// `next` differs only by a camera move or by the end of continuous turning or of playing. If something else has ended
/// the playing, undo does not begin it again. Then removes the oldest undo steps until the history is within `limits`.
/// Does nothing if `next` equals the current state.
void commit(Session& session, State next, const Limits& limits);

/// Like commit(), but `next` becomes a part of the last undo step: undo returns to the state before that step. If there
/// is no undo step, or if there are redo steps, works like commit().
void amend(Session& session, State next, const Limits& limits);

/// Returns the state before the undo step that amend() extends; null if amend() works like commit().
const State* stateBeforeAmendableStep(const Session& session);

/// Removes the older half of the undo steps, to free memory.
void forgetOlderHalf(Session& session);

/// Undoes or redoes one step. Does not move the camera. Error: `nothing_to_undo` if no step differs from the current
/// state.
Result<std::monostate> undo(Session& session);
Result<std::monostate> redo(Session& session);

}  // namespace oval4d::session
