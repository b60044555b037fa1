#include "session/session.hpp"

#include <map>
#include <numbers>
#include <utility>

#include "polytopes/catalogue/catalogue.hpp"
#include "polytopes/catalogue/polytope_cache.hpp"
#include "session/history.hpp"
#include "session/keymap.hpp"
#include "session/object_loader.hpp"
#include "session/settings.hpp"
#include "text/message_text.hpp"

namespace oval4d::session {

namespace {

using Done = Result<std::monostate>;

// Applies each command to a copy of the state, which becomes the current state only on success.
class Applier {
  public:
    Applier(Session& session, const Limits& limits, ObjectLoader& loader)
        : session_(session), limits_(limits), loader_(loader) {}

    Done operator()(const Key& key) {
        std::string pending = session_.pendingKey;
        const auto binding = bindingOf(key, pending);
        if (!binding) return binding.error();
        Done done = *binding ? press(**binding) : Done(std::monostate{});
        if (done) session_.pendingKey = std::move(pending);
        return done;
    }
    Done operator()(const Rotate& command) {
        if (Done valid = checkTurn(command.turn); !valid) return valid;
        State next = session_.current;
        rotate(next, command.turn);
        (command.continues ? amend : commit)(session_, std::move(next), limits_);
        return std::monostate{};
    }
    Done operator()(const TurnToward& command) {
        State next = session_.current;
        if (Done done = turnToward(next, command); !done) return done;
        commit(session_, std::move(next), limits_);
        return std::monostate{};
    }
    Done operator()(const Set& command) {
        State next = session_.current;
        if (Done done = applySet(next, command, session_.loaded, limits_, loader_); !done) return done;
        (command.continues ? amend : commit)(session_, std::move(next), limits_);
        return std::monostate{};
    }
    Done operator()(const Load& command) {
        if (session_.loaded.size() >= limits_.maxLoaded && !session_.loaded.contains(command.name)) {
            return Error{ErrorCode::too_many, "a session holds at most " + std::to_string(limits_.maxLoaded) +
                                                  " loaded polytopes; load under a name that is in use to replace one"};
        }
        const auto reading = loader_.objectFrom(command);
        if (!reading) return reading.error();
        State next = session_.current;
        replaceObject(next, reading->object);
        session_.loaded.insert_or_assign(command.name, reading->object);
        commit(session_, std::move(next), limits_);
        return std::monostate{};
    }
    Done operator()(const Undo& /*command*/) { return undo(session_); }
    Done operator()(const Redo& /*command*/) { return redo(session_); }
    Done operator()(const Reset& /*command*/) {
        State next = session_.current;
        next.orientation = {};
        next.slices.focus = 0;
        next.slices.offset = 0;
        next.turning = false;
        next.ongoingTurnToward.reset();
        commit(session_, std::move(next), limits_);
        return std::monostate{};
    }
    Done operator()(const CommandLine& command) {
        const auto parsed = parseCommandLine(command.line, session_.current);
        if (!parsed) return parsed.error();
        return std::visit(*this, *parsed);
    }

  private:
    Done press(const Binding& binding) {
        if (binding.action->onSession != nullptr) return binding.action->onSession(session_);
        State next = session_.current;
        ActionContext context{next,          session_.loaded,          limits_,        loader_,
                              binding.plane, binding.isDoubleRotation, binding.inverse};
        if (Done done = binding.action->onState(context); !done) return done;
        commit(session_, std::move(next), limits_);
        return std::monostate{};
    }

    Session& session_;
    const Limits& limits_;
    ObjectLoader& loader_;
};

}  // namespace

geometry::Hyperplanes State::hyperplanes() const {
    return {slices.focus - (slices.count - 1) / 2, slices.count, slices.spacing, slices.offset};
}

State initialState() {
    constexpr double kAngle = std::numbers::pi / 36;
    State state;
    state.object = polytopes::fiveCell();
    state.alpha = state.beta = kAngle;
    state.step = std::numbers::pi / 180;
    state.slices.spacing = spanningSpacing(state.object, state.slices.count);
    return state;
}

double spanningSpacing(const slicing::Object& object, int count) {
    const double radius = slicing::infoOf(object).circumradius;
    return count > 1 ? 2 * radius / (count - 1) : radius;
}

Done apply(Session& session, const Command& command, const Limits& limits, ObjectLoader& loader) {
    return std::visit(Applier(session, limits, loader), command);
}

std::size_t historyBytes(const Session& session) {
    return sizeof(State) * (session.undoSteps.size() + session.redoSteps.size());
}

std::size_t objectBytes(const Session& session) {
    std::map<const void*, const slicing::Object*> objects;
    auto add = [&, last = static_cast<const void*>(nullptr)](const slicing::Object& object) mutable {
        const void* identity = slicing::identityOf(object);
        if (identity != std::exchange(last, identity))
            objects.try_emplace(identity, &object);  // skipped if the previous state has the same object, as most do
    };
    add(session.current.object);
    for (const auto& [name, object] : session.loaded) add(object);
    for (const State& state : session.undoSteps) add(state.object);
    for (const State& state : session.redoSteps) add(state.object);
    std::size_t bytes = 0;
    for (const auto& [identity, object] : objects) {
        const geometry::ObjectInfo& info = slicing::infoOf(*object);
        const bool shared = info.rebuildableFromName && polytopes::findEntry(info.name) != nullptr;
        if (!shared) bytes += slicing::memoryOf(*object);
    }
    return bytes;
}

void advance(Session& session, double seconds) {
    State& state = session.current;
    if (state.ongoingTurnToward) {
        auto& [goal, left] = *state.ongoingTurnToward;
        if (seconds < left) {
            const geometry::Rotation way = goal * state.orientation.inverse();
            state.orientation = way.power(seconds / left) * state.orientation;
            left -= seconds;
        } else {
            state.orientation = goal;
            state.ongoingTurnToward.reset();
        }
    } else if (state.turning && state.lastTurn) {
        state.orientation = geometry::Rotation(state.lastTurn->scaled(kTurnsPerSecond * seconds)) * state.orientation;
    } else {
        return;
    }
    ++session.revision;
}

}  // namespace oval4d::session
