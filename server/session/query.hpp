#pragma once
// States described by names and values: the query of a URL, or the options of `oval4d render`.

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

/// Returns the state that a query describes. Its names are those of ":set", and "rotate", which may occur any number of
/// times; rotations are applied in order. The state starts as initialState(), with `object`, if given, in place of the
/// 5-cell. `loader` provides the polytopes. Error for an unknown name: `unknown_command`, which lists the allowed
/// names.
Result<State> stateFromQuery(const Query& query, const Limits& limits, ObjectLoader& loader,
                             std::optional<slicing::Object> object = {});

}  // namespace oval4d::session
