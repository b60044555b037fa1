#include "session/history.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>

namespace oval4d::session {

namespace {

// Returns `state` with the camera at this orbit.
State withOrbit(State state, const scene::Orbit& orbit) {
    state.look.orbit = orbit;
    return state;
}

std::size_t bytesOfFilter(const State& state) {
    return sizeof(std::uint32_t) * (state.look.cellTypes.hidden.size() + state.look.cellTypes.faded.size());
}

/// Removes the oldest undo steps until the memory that only undo steps use is at most `maxBytes`. This memory consists
/// of objects, and of the lists of hidden and faded cell types.
void limitHistoryBytes(Session& session, std::size_t maxBytes) {
    std::map<const void*, std::size_t> steps;  // the number of steps that use each object
    std::size_t bytes = 0;
    const auto isHeld = [&](const slicing::Object& object) {
        return object == session.now.object ||
               std::ranges::any_of(session.loaded, [&](const auto& own) { return own.second == object; });
    };
    for (const State& step : session.past) {
        bytes += bytesOfFilter(step);
        if (!isHeld(step.object) && ++steps[slicing::identityOf(step.object)] == 1)
            bytes += slicing::memoryOf(step.object);
    }
    while (bytes > maxBytes && !session.past.empty()) {
        const State& oldest = session.past.front();
        bytes -= bytesOfFilter(oldest);
        const auto held = steps.find(slicing::identityOf(oldest.object));
        if (held != steps.end() && --held->second == 0) bytes -= slicing::memoryOf(oldest.object);
        session.past.pop_front();
    }
}

}  // namespace

void commit(Session& session, State next, const Limits& limits) {
    if (next == session.now) return;
    State before = withOrbit(session.now, next.look.orbit);
    before.turning = before.turning && next.turning;  // stopping belongs to the history step that started turning
    if (before != next) {
        if (limits.maxUndo > 0) session.past.push_back(session.now);
        while (session.past.size() > limits.maxUndo) session.past.pop_front();
        session.future.clear();
    }
    session.now = std::move(next);
    ++session.revision;
    const bool grows = !session.past.empty() &&
                       (session.past.back().object != session.now.object || bytesOfFilter(session.past.back()) > 0);
    if (grows) limitHistoryBytes(session, limits.maxUndoBytes);
}

void forgetOlderHalf(Session& session) {
    const auto half = static_cast<std::ptrdiff_t>((session.past.size() + 1) / 2);
    session.past.erase(session.past.begin(), session.past.begin() + half);
}

Result<std::monostate> undo(Session& session) {
    if (session.past.empty())
        return Error{ErrorCode::nothing_to_undo, "nothing to undo: the session is at its first state"};
    session.future.push_back(session.now);
    session.now = withOrbit(std::move(session.past.back()), session.now.look.orbit);
    session.past.pop_back();
    ++session.revision;
    return std::monostate{};
}

Result<std::monostate> redo(Session& session) {
    if (session.future.empty())
        return Error{ErrorCode::nothing_to_undo, "nothing to redo: nothing has been undone since the last change"};
    session.past.push_back(session.now);
    session.now = withOrbit(std::move(session.future.back()), session.now.look.orbit);
    session.future.pop_back();
    ++session.revision;
    return std::monostate{};
}

}  // namespace oval4d::session
