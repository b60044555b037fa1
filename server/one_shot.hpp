#pragma once
// What the commands have in common that make one thing of a state given on the command line, without a server.

#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "protocol/cpp/error.hpp"
#include "session/query.hpp"

namespace oval4d {

/// "--name value" and "--name=value" as a query, in the order in which they were typed. Throws std::runtime_error.
session::Query queryOf(const std::vector<std::string>& words);

/// The state that the query describes; "load" names a file whose polytope it shows. Says on standard error what was
/// repaired in it. Throws std::runtime_error.
session::State stateOf(session::Query query);

/// The value, or its error as a std::runtime_error.
template <typename T>
T valueOf(protocol::Result<T> result) {
    if (!result) throw std::runtime_error(result.error().message);
    return std::move(*result);
}

/// Writes a file, or with "-" to standard output. Throws std::runtime_error.
void writeOutput(const std::string& path, std::string_view bytes);

/// How a state is described, for `--help`.
inline constexpr const char* kStateHelp =
    "Any other option describes the state, as :set and the query of frame.png do:\n"
    "  --polytope 24-cell --rotate xw,yz:pi/8,pi/sqrt(3)-pi/8 --slices 31 --view single\n"
    "--load FILE shows the polytope of a file: 4OFF, or points, of which it takes the convex hull.\n"
    "--rotate may be repeated; the rotations are carried out in the order given.";

}  // namespace oval4d
