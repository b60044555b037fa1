#include "session/history.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>

namespace oval4d::session {

namespace {

// Returns a copy of `state` in which the camera has the given orbit.
State withOrbit(State state, const scene::CameraOrbit& orbit) {
    state.look.orbit = orbit;
    return state;
}

// Returns whether two states are equal apart from the camera. If State::source and the frame of reference are equal,
// State::object counts as equal, even if the object was transformed to this frame twice.
bool differOnlyInCamera(const State& a, const State& b) {
    State compared = withOrbit(a, b.look.orbit);
    if (a.source == b.source && a.referenceFrame == b.referenceFrame) compared.object = b.object;
    return compared == b;
}

// Returns whether the change from `before` to `next` needs an undo step of its own. The end of continuous turning or of
// playing needs none, because it belongs to the step that started the motion.
bool isNewUndoStep(State before, const State& next) {
    before.turning = before.turning && next.turning;
    before.playing = before.playing && next.playing;
    return !differOnlyInCamera(before, next);
}

// Appends `state` to `steps`. If the last step equals `state` apart from the camera, `state` replaces it.
template <typename Steps>
void addStep(Steps& steps, const State& state) {
    if (!steps.empty() && differOnlyInCamera(steps.back(), state)) steps.pop_back();
    steps.push_back(state);
}

// Finds the last step of `from` that differs from the current state in more than the camera. Makes this step the
// current state, with the present camera, and appends the old current state to `to`. Removes this step and all later
// steps from `from`. Returns false and changes nothing if there is no such step.
template <typename From, typename To>
bool stepThroughHistory(Session& session, From& from, To& to) {
    const auto isOther = [&](const State& step) { return !differOnlyInCamera(step, session.current); };
    const auto found = std::find_if(from.rbegin(), from.rend(), isOther);
    if (found == from.rend()) return false;
    State next = withOrbit(std::move(*found), session.current.look.orbit);
    from.erase(std::prev(found.base()), from.end());
    addStep(to, session.current);
    session.current = std::move(next);
    ++session.revision;
    return true;
}

std::size_t filterMemoryOf(const State& state) {
    return sizeof(std::uint32_t) * (state.look.cellTypes.hidden.size() + state.look.cellTypes.faded.size());
}

/// Removes the oldest undo steps until the memory that only undo steps use is at most `maxBytes`. This memory consists
/// of two parts. The first part is the lists of hidden and faded cell types of all undo steps. The second part is the
/// objects that are neither in the current state nor in Session::loaded; each object counts once, with
/// unsharedMemory(). Redo steps do not count.
void limitHistoryBytes(Session& session, std::size_t maxBytes) {
    std::map<const void*, std::size_t> steps;  // how many times undo steps contain an object, by slicing::identityOf()
    std::size_t bytes = 0;
    const auto isHeld = [&](const slicing::Object& object) {
        return object == session.current.object || object == session.current.source ||
               std::ranges::any_of(session.loaded, [&](const auto& own) { return own.second == object; });
    };
    for (const State& step : session.undoSteps) {
        bytes += filterMemoryOf(step);
        for (const slicing::Object* object : step.sourceAndObject()) {
            if (!isHeld(*object) && ++steps[slicing::identityOf(*object)] == 1) bytes += unsharedMemory(*object);
        }
    }
    while (bytes > maxBytes && !session.undoSteps.empty()) {
        const State& oldest = session.undoSteps.front();
        bytes -= filterMemoryOf(oldest);
        for (const slicing::Object* object : oldest.sourceAndObject()) {
            const auto held = steps.find(slicing::identityOf(*object));
            if (held != steps.end() && --held->second == 0) bytes -= unsharedMemory(*object);
        }
        session.undoSteps.pop_front();
    }
}

// Makes `next` the current state, without an undo step. `next` must differ from the current state.
void replaceCurrentState(Session& session, State next, const Limits& limits) {
    const bool historyGrows = session.current.object != next.object || session.current.source != next.source ||
                              filterMemoryOf(session.current) > 0;
    session.current = std::move(next);
    ++session.revision;
    if (historyGrows) limitHistoryBytes(session, limits.maxUndoBytes);
}

}  // namespace

void commitUndoStep(Session& session, State next, const Limits& limits) {
    if (next == session.current) return;
    if (isNewUndoStep(session.current, next)) {
        session.current.playing = session.current.playing && next.playing;
        addStep(session.undoSteps, session.current);
        while (session.undoSteps.size() > limits.maxUndo) session.undoSteps.pop_front();
        session.redoSteps.clear();
    }
    replaceCurrentState(session, std::move(next), limits);
}

const State* stateBeforeAmendableStep(const Session& session) {
    return session.undoSteps.empty() || !session.redoSteps.empty() ? nullptr : &session.undoSteps.back();
}

void amendUndoStep(Session& session, State next, const Limits& limits) {
    if (stateBeforeAmendableStep(session) == nullptr) return commitUndoStep(session, std::move(next), limits);
    if (next == session.current) return;
    replaceCurrentState(session, std::move(next), limits);
}

void forgetOlderUndoSteps(Session& session) {
    const auto half = static_cast<std::ptrdiff_t>((session.undoSteps.size() + 1) / 2);
    session.undoSteps.erase(session.undoSteps.begin(), session.undoSteps.begin() + half);
}

Result<std::monostate> undo(Session& session) {
    if (stepThroughHistory(session, session.undoSteps, session.redoSteps)) return std::monostate{};
    return Error{ErrorCode::nothing_to_undo, "nothing to undo: the session is at its first state"};
}

Result<std::monostate> redo(Session& session) {
    if (stepThroughHistory(session, session.redoSteps, session.undoSteps)) return std::monostate{};
    return Error{ErrorCode::nothing_to_undo, "nothing to redo: nothing has been undone since the last change"};
}

}  // namespace oval4d::session
