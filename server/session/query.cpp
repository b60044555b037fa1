#include "session/query.hpp"

#include <utility>
#include <vector>

#include "geometry/rotation.hpp"
#include "protocol/cpp/suggest.hpp"
#include "session/command_line.hpp"
#include "session/expression.hpp"
#include "session/settings.hpp"

namespace oval4d::session {

protocol::Result<State> stateFromQuery(const Query& query, const Limits& limits, PolytopePtr polytope) {
    // All settings at once, then the rotations: a count and a spacing mean the same in either order.
    protocol::Set set;
    std::vector<geometry::Turn> turns;
    for (const auto& [name, value] : query) {
        if (name == "rotate") {
            const auto turn = parseTurn(value);
            if (!turn) return turn.error();
            if (auto sound = checkTurn(*turn); !sound) return sound.error();
            turns.push_back(*turn);
        } else if (auto done = putSetting(name, value, set); !done) {
            protocol::Error error = done.error();
            if (error.code == protocol::ErrorCode::unknown_command) error.message += ", rotate";
            return error;
        }
    }
    State state = initialState();
    if (polytope) show(state, std::move(polytope));
    for (const geometry::Turn& turn : turns) rotate(state, turn);
    Workshop workshop(limits);
    if (auto done = applySet(state, set, {}, limits, workshop); !done) return done.error();
    return state;
}

}  // namespace oval4d::session
