#pragma once
// What was, and what undo took back.

#include "session/session.hpp"

namespace oval4d::session {

/// Makes `next` the session's present. A step of the history, unless only the camera has moved or a continuous turn
/// has stopped; nothing at all if nothing has changed.
void commit(Session& session, State next, const Limits& limits);

protocol::Result<std::monostate> undo(Session& session);
protocol::Result<std::monostate> redo(Session& session);

}  // namespace oval4d::session
