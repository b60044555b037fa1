#pragma once
// Converts names and values, from the query of a URL or the options of `oval4d render`, to a state.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "errors/error.hpp"
#include "session/object_loader.hpp"
#include "session/session.hpp"

namespace oval4d::session {

/// Pairs of names and values in the order given; a name may occur more than once.
using Query = std::vector<std::pair<std::string, std::string>>;

/// Returns the state that a query describes. The names in the query are those that parseSetting accepts; "rotate",
/// which may occur any number of times; and "toward", such as "cell" or "cell:3". Rotations are applied in the order
/// given, and "toward" after everything else. Settings that the query does not contain are those of initialState(), but
/// with `object`, if given, in place of the 5-cell. `loader` provides the polytopes. Errors: `unknown_command` for an
/// unknown name, with the allowed names; those of parseSetting, parseTurn, checkTurn, parseElementKind,
/// parseElementIndex, turnToward and applySet.
Result<State> stateFromQuery(const Query& query, const Limits& limits, ObjectLoader& loader,
                             std::optional<slicing::Object> object = {});

}  // namespace oval4d::session
