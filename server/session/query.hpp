#pragma once
// Converts names and values, from the query of a URL or the options of `oval4d render`, to a state.

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "errors/error.hpp"
#include "fields/scalar_function.hpp"
#include "session/object_loader.hpp"
#include "session/session.hpp"

namespace oval4d::session {

/// The parameters of a URL query: pairs of names and values, in the order given. A name may occur more than once.
using QueryParameters = std::vector<std::pair<std::string, std::string>>;

/// Parses the ranges of x, y, z and w: eight numbers or expressions, separated by commas. Errors: `bad_expression` and
/// those of evaluate().
Result<fields::Box> parseBox(std::string_view text);

/// Returns the state that a query describes. The names in the query are those that parseSetting() accepts; "rotate",
/// which may occur any number of times; and "toward", such as "cell" or "cell:3". Rotations are applied in the order
/// given, and "toward" after everything else. Settings that the query does not contain are those of `state`. `loader`
/// provides the polytopes. Errors: `unknown_command` for an unknown name, with the allowed names; those of
/// parseSetting(), parseTurn(), checkTurn(), parseElementKind(), parseElementIndex(), turnToward() and applySet().
Result<State> stateFromQuery(const QueryParameters& query, const Limits& limits, ObjectLoader& loader,
                             State state = initialState());

}  // namespace oval4d::session
