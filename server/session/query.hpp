#pragma once
// A state described by names and values: the query of an URL and the options of `oval4d render`.

#include <string>
#include <utility>
#include <vector>

#include "protocol/cpp/error.hpp"
#include "session/session.hpp"

namespace oval4d::session {

/// In the order in which they were given; a name may stand more than once.
using Query = std::vector<std::pair<std::string, std::string>>;

/// The state that the query describes: "polytope", "rotate" (any number, carried out in order), and every name that
/// ":set" takes. Starts from initialState(), or with `polytope` in place of the 5-cell. An unknown name is an error
/// that lists the allowed ones.
protocol::Result<State> stateFromQuery(const Query& query, const Limits& limits, PolytopePtr polytope = nullptr);

}  // namespace oval4d::session
