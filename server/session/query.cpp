#include "session/query.hpp"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "geometry/rotation.hpp"
#include "session/command_line.hpp"
#include "session/expression.hpp"
#include "session/settings.hpp"
#include "text/message_text.hpp"

namespace oval4d::session {

Result<State> stateFromQuery(const Query& query, const Limits& limits, ObjectLoader& loader,
                             std::optional<slicing::Object> object) {
    // Settings are collected and applied together, so that a count and a spacing in either order give the same state.
    Set set;
    std::vector<geometry::Turn> turns;
    std::optional<TurnToward> toward;
    for (const auto& [name, value] : query) {
        if (name == "rotate") {
            const auto turn = parseTurn(value);
            if (!turn) return turn.error();
            if (auto valid = checkTurn(*turn); !valid) return valid.error();
            turns.push_back(*turn);
        } else if (name == "toward") {
            const std::string_view element = value;
            const std::size_t colon = std::min(element.find(':'), element.size());
            const auto kind = parseElementKind(element.substr(0, colon));
            if (!kind) return kind.error();
            toward = TurnToward{*kind, {}, true};
            if (colon < element.size()) {
                const auto index = parseElementIndex(element.substr(colon + 1));
                if (!index) return index.error();
                toward->index = *index;
            }
        } else if (auto done = parseSetting(name, value, set); !done) {
            Error error = done.error();
            if (error.code == ErrorCode::unknown_command) error.message += ", rotate, toward";
            return error;
        }
    }
    State state = initialState();
    if (object) replaceObject(state, std::move(*object));
    for (const geometry::Turn& turn : turns) rotate(state, turn);
    if (auto done = applySet(state, set, {}, limits, loader); !done) return done.error();
    if (toward) {
        if (auto done = turnToward(state, *toward); !done) return done.error();
    }
    return state;
}

}  // namespace oval4d::session
