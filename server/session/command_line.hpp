#pragma once
// The page's command line, which opens with the key ':'.

#include <string_view>

#include "errors/error.hpp"
#include "session/command.hpp"
#include "session/session.hpp"

namespace oval4d::session {

/// Parses a line of the page's command line, such as "polytope 24-cell", "set slices=31", "rotate xw,yz pi/8 pi/5" or
/// "reset"; a ':' may precede it. Some results depend on `state`, the current state. "rotate" without angles gives a
/// Rotate by the angles alpha and beta of `state`. "hide", "fade" and "show" give a ChangeSettings with the changed
/// lists of cell types. "region" gives a LoadObject that reads another region from the file of the shown field. Errors:
/// `unknown_command`, `bad_expression`, `out_of_range`, `unknown_polytope`, `unknown_key`.
Result<Command> parseCommandLine(std::string_view written, const State& state);

}  // namespace oval4d::session
