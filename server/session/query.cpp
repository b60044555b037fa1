#include "session/query.hpp"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "geometry/rotation.hpp"
#include "session/command_line.hpp"
#include "session/expression.hpp"
#include "session/load.hpp"
#include "session/settings.hpp"
#include "text/message_text.hpp"

namespace oval4d::session {

Result<fields::Box> parseBox(std::string_view text) {
    fields::Box box;
    std::string_view rest = text;
    for (int i = 0; i < 8; ++i) {
        const std::size_t comma = rest.find(',');
        if ((comma == std::string_view::npos) != (i == 7)) {
            return Error{ErrorCode::bad_expression,
                         "box must be eight numbers, the ranges of x, y, z and w, such as -1,1,-1,1,-1,1,0,2, not " +
                             text::inQuotes(text)};
        }
        const auto value = evaluate(rest.substr(0, comma));
        if (!value) return Error{value.error().code, "box: " + value.error().message};
        (i % 2 == 0 ? box.min : box.max)[i / 2] = *value;
        rest.remove_prefix(std::min(comma, rest.size() - 1) + 1);
    }
    return box;
}

Result<State> stateFromQuery(const QueryParameters& query, const Limits& limits, ObjectLoader& loader, State state) {
    // Settings are collected and applied together, so that a count and a spacing in either order give the same state.
    Set set;
    std::vector<geometry::Turn> turns;
    std::optional<TurnToward> toward;
    LoadObject field{std::string(kFormula), std::string(kFormula), {}};
    for (const auto& [name, value] : query) {
        if (name == "rotate") {
            const auto turn = parseTurn(value);
            if (!turn) return turn.error();
            if (auto valid = checkTurn(*turn); !valid) return valid.error();
            turns.push_back(*turn);
        } else if (name == "formula") {
            field.data = value;
        } else if (name == "values") {
            field.values = value;
        } else if (name == "box") {
            const auto box = parseBox(value);
            if (!box) return box.error();
            field.box = *box;
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
            if (error.code == ErrorCode::unknown_command) error.message += ", rotate, toward, formula, values, box";
            return error;
        }
    }
    const auto has = [&](std::string_view wanted) {
        return std::ranges::any_of(query, [&](const auto& pair) { return pair.first == wanted; });
    };
    for (const std::string_view name : {"box", "values"}) {
        if (has(name) && !has("formula"))
            return Error{ErrorCode::bad_expression, std::string(name) + " needs a formula"};
    }
    if (has("formula")) {
        if (set.object)
            return Error{ErrorCode::bad_expression, "a formula and another object cannot be shown at the same time"};
        auto made = readFormula(field);
        if (!made) return made.error();
        if (auto done = replaceObject(state, std::move(made->object), loader); !done) return done.error();
    }
    for (const geometry::Turn& turn : turns) rotate(state, turn);
    if (auto done = applySet(state, set, {}, limits, loader); !done) return done.error();
    if (toward) {
        if (auto done = turnToward(state, *toward); !done) return done.error();
    }
    return state;
}

}  // namespace oval4d::session
