#include "session/session.hpp"

#include <numbers>
#include <utility>

#include "geometry/catalogue.hpp"
#include "protocol/cpp/suggest.hpp"
#include "session/history.hpp"
#include "session/keys.hpp"
#include "session/settings.hpp"
#include "session/workshop.hpp"

namespace oval4d::session {

namespace {

using protocol::Error;
using protocol::ErrorCode;
using protocol::Result;
using Done = Result<std::monostate>;

// Each command works on a copy of the state, which becomes the present only if all went well.
class Applier {
  public:
    Applier(Session& session, const Limits& limits, Workshop& workshop)
        : session_(session), limits_(limits), workshop_(workshop) {}

    Done operator()(const protocol::Key& key) {
        std::string pending = session_.pendingKey;
        const auto binding = bindingOf(key, pending);
        if (!binding) return binding.error();
        Done done = *binding ? press(**binding) : Done(std::monostate{});
        if (done) session_.pendingKey = std::move(pending);
        return done;
    }
    Done operator()(const protocol::Rotate& command) {
        if (Done sound = checkTurn(command.turn); !sound) return sound;
        State next = session_.now;
        rotate(next, command.turn);
        commit(session_, std::move(next), limits_);
        return std::monostate{};
    }
    Done operator()(const protocol::Set& command) {
        State next = session_.now;
        if (Done done = applySet(next, command, session_.loaded, limits_, workshop_); !done) return done;
        commit(session_, std::move(next), limits_);
        return std::monostate{};
    }
    Done operator()(const protocol::Load& command) {
        if (session_.loaded.size() >= limits_.maxLoaded && !session_.loaded.contains(command.name)) {
            return Error{ErrorCode::too_many, "a session holds at most " + std::to_string(limits_.maxLoaded) +
                                                  " loaded polytopes; load under a name that is in use to replace one"};
        }
        const auto reading = workshop_.reading(command);
        if (!reading) return reading.error();
        State next = session_.now;
        show(next, reading->polytope);
        session_.loaded.insert_or_assign(command.name, reading->polytope);
        commit(session_, std::move(next), limits_);
        return std::monostate{};
    }
    Done operator()(const protocol::Undo& /*command*/) { return undo(session_); }
    Done operator()(const protocol::Redo& /*command*/) { return redo(session_); }
    Done operator()(const protocol::Reset& /*command*/) {
        State next = session_.now;
        next.orientation = {};
        next.slices.focus = 0;
        next.turning = false;
        commit(session_, std::move(next), limits_);
        return std::monostate{};
    }
    Done operator()(const protocol::CommandLine& command) {
        const auto parsed = parseCommandLine(command.line, session_.now);
        if (!parsed) return parsed.error();
        return std::visit(*this, *parsed);
    }

  private:
    Done press(const Binding& binding) {
        if (binding.action == Action::undo) return undo(session_);
        if (binding.action == Action::redo) return redo(session_);
        State next = session_.now;
        if (Done done = act(next, binding, session_.loaded, limits_, workshop_); !done) return done;
        commit(session_, std::move(next), limits_);
        return std::monostate{};
    }

    Session& session_;
    const Limits& limits_;
    Workshop& workshop_;
};

}  // namespace

geometry::Hyperplanes State::hyperplanes() const {
    return {slices.focus - (slices.count - 1) / 2, slices.count, slices.spacing};
}

State initialState() {
    constexpr double kAngle = std::numbers::pi / 36;
    State state;
    state.polytope = geometry::polytopeOf(geometry::catalogue().front());
    state.alpha = state.beta = kAngle;
    state.step = std::numbers::pi / 180;
    state.slices.spacing = spanningSpacing(*state.polytope, state.slices.count);
    return state;
}

double spanningSpacing(const geometry::Polytope& polytope, int count) {
    return count > 1 ? 2 * polytope.circumradius / (count - 1) : polytope.circumradius;
}

Done apply(Session& session, const protocol::Command& command, const Limits& limits) {
    Workshop workshop(limits);
    return apply(session, command, limits, workshop);
}

Done apply(Session& session, const protocol::Command& command, const Limits& limits, Workshop& workshop) {
    return std::visit(Applier(session, limits, workshop), command);
}

void advance(Session& session, double seconds) {
    if (!session.now.turning || !session.now.last) return;
    const geometry::Rotation turn(session.now.last->scaled(kTurnsPerSecond * seconds));
    session.now.orientation = turn * session.now.orientation;
    ++session.revision;
}

}  // namespace oval4d::session
