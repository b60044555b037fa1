#include "session/history.hpp"

#include <utility>

namespace oval4d::session {

namespace {

using protocol::Error;
using protocol::ErrorCode;
using protocol::Result;

// The camera stays where the viewer has put it.
State seenFrom(State state, const scene::Orbit& orbit) {
    state.look.orbit = orbit;
    return state;
}

}  // namespace

void commit(Session& session, State next, const Limits& limits) {
    if (next == session.now) return;
    State before = seenFrom(session.now, next.look.orbit);
    before.turning = before.turning && next.turning;  // a stop belongs to the step that began the turn
    if (before != next) {
        if (limits.maxUndo > 0) session.past.push_back(session.now);
        while (session.past.size() > limits.maxUndo) session.past.pop_front();
        session.future.clear();
    }
    session.now = std::move(next);
    ++session.revision;
}

Result<std::monostate> undo(Session& session) {
    if (session.past.empty())
        return Error{ErrorCode::nothing_to_undo, "nothing to undo: the session is at its first state"};
    session.future.push_back(session.now);
    session.now = seenFrom(std::move(session.past.back()), session.now.look.orbit);
    session.past.pop_back();
    ++session.revision;
    return std::monostate{};
}

Result<std::monostate> redo(Session& session) {
    if (session.future.empty())
        return Error{ErrorCode::nothing_to_undo, "nothing to redo: nothing has been undone since the last change"};
    session.past.push_back(session.now);
    session.now = seenFrom(std::move(session.future.back()), session.now.look.orbit);
    session.future.pop_back();
    ++session.revision;
    return std::monostate{};
}

}  // namespace oval4d::session
