#include "session/history.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>

namespace oval4d::session {

namespace {

// Returns `state` with the camera at this orbit.
State withOrbit(State state, const scene::CameraOrbit& orbit) {
    state.look.orbit = orbit;
    return state;
}

std::size_t bytesOfFilter(const State& state) {
    return sizeof(std::uint32_t) * (state.look.cellTypes.hidden.size() + state.look.cellTypes.faded.size());
}

/// Removes the oldest undo steps until the memory that only undo steps use is at most `maxBytes`. This memory consists
/// of objects that neither the current state nor `loaded` contains, and of the lists of hidden and faded cell types.
void limitHistoryBytes(Session& session, std::size_t maxBytes) {
    std::map<const void*, std::size_t> steps;  // how often the steps use each object
    std::size_t bytes = 0;
    const auto isHeld = [&](const slicing::Object& object) {
        return object == session.current.object || object == session.current.source ||
               std::ranges::any_of(session.loaded, [&](const auto& own) { return own.second == object; });
    };
    for (const State& step : session.undoSteps) {
        bytes += bytesOfFilter(step);
        for (const slicing::Object* object : step.objects()) {
            if (!isHeld(*object) && ++steps[slicing::identityOf(*object)] == 1) bytes += ownMemory(*object);
        }
    }
    while (bytes > maxBytes && !session.undoSteps.empty()) {
        const State& oldest = session.undoSteps.front();
        bytes -= bytesOfFilter(oldest);
        for (const slicing::Object* object : oldest.objects()) {
            const auto held = steps.find(slicing::identityOf(*object));
            if (held != steps.end() && --held->second == 0) bytes -= ownMemory(*object);
        }
        session.undoSteps.pop_front();
    }
}

}  // namespace

void commit(Session& session, State next, const Limits& limits) {
    if (next == session.current) return;
    State before = withOrbit(session.current, next.look.orbit);
    before.turning = before.turning && next.turning;  // stopping belongs to the history step that started turning
    if (before != next) {
        if (limits.maxUndo > 0) session.undoSteps.push_back(session.current);
        while (session.undoSteps.size() > limits.maxUndo) session.undoSteps.pop_front();
        session.redoSteps.clear();
    }
    session.current = std::move(next);
    ++session.revision;
    const bool grows = !session.undoSteps.empty() && (session.undoSteps.back().object != session.current.object ||
                                                      bytesOfFilter(session.undoSteps.back()) > 0);
    if (grows) limitHistoryBytes(session, limits.maxUndoBytes);
}

void amend(Session& session, State next, const Limits& limits) {
    if (session.undoSteps.empty() || !session.redoSteps.empty()) return commit(session, std::move(next), limits);
    if (next == session.current) return;
    session.current = std::move(next);
    ++session.revision;
}

void forgetOlderHalf(Session& session) {
    const auto half = static_cast<std::ptrdiff_t>((session.undoSteps.size() + 1) / 2);
    session.undoSteps.erase(session.undoSteps.begin(), session.undoSteps.begin() + half);
}

Result<std::monostate> undo(Session& session) {
    if (session.undoSteps.empty())
        return Error{ErrorCode::nothing_to_undo, "nothing to undo: the session is at its first state"};
    session.redoSteps.push_back(session.current);
    session.current = withOrbit(std::move(session.undoSteps.back()), session.current.look.orbit);
    session.undoSteps.pop_back();
    ++session.revision;
    return std::monostate{};
}

Result<std::monostate> redo(Session& session) {
    if (session.redoSteps.empty())
        return Error{ErrorCode::nothing_to_undo, "nothing to redo: nothing has been undone since the last change"};
    session.undoSteps.push_back(session.current);
    session.current = withOrbit(std::move(session.redoSteps.back()), session.current.look.orbit);
    session.redoSteps.pop_back();
    ++session.revision;
    return std::monostate{};
}

}  // namespace oval4d::session
