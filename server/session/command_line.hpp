#pragma once
// The page's command line, which is typed after ':'.

#include <string_view>

#include "errors/error.hpp"
#include "session/command.hpp"
#include "session/session.hpp"

namespace oval4d::session {

/// Parses a line of the page's command line, with or without the ':', such as "polytope 24-cell", "set slices=31",
/// "rotate xw,yz pi/8 pi/5" or "reset". `state` is the current state, on which some results depend: "rotate" without
/// angles gives a Rotate by the angles of `state`; "hide", "fade" and "show" give a Set with the changed lists of cell
/// types of `state`; "region" gives a LoadObject from the file of the field in `state`. Errors: `unknown_command`,
/// `bad_expression`, `out_of_range`, `unknown_polytope`, `unknown_key`.
Result<Command> parseCommandLine(std::string_view written, const State& state);

}  // namespace oval4d::session
