#pragma once
// Functions for the subcommands `render` and `export`, which write a file from a state that the command line describes.

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "errors/error.hpp"
#include "session/query.hpp"

namespace oval4d {

/// Converts arguments of the forms "--name value" and "--name=value" to a query: pairs of a name and a value, in the
/// order of the arguments. Throws std::runtime_error if an argument does not begin with "--" or has no value.
session::QueryParameters queryFromArguments(const std::vector<std::string>& words);

/// Returns the state that a query describes. The parameter "load" is the path of what to show:
/// - an object: a file, a Zarr folder, or a folder with a series of files (see fields::readSeries()). It is shown in
/// the
///   initial state. Some parameters say how to read the object: for an array, "axes", "box", "region", "variable",
///   "values" and "values_variable"; for a polytope, a surface or a list of points, "center", the point about which the
///   object turns.
/// - a state: a file with a `state` message, or a picture made by oval4d.
///
/// All other parameters change this state; without "load", they change the initial state. Prints warnings about the
/// file to standard error. `others` are the names of further options of the subcommand, which the error message about
/// an unknown option also lists. On failure, throws std::runtime_error with a message for the user.
session::State loadState(session::QueryParameters query, std::span<const std::string_view> others);

/// Returns the value of `result`. If `result` is an error, throws its message as a std::runtime_error.
template <typename T>
T valueOrThrow(Result<T> result) {
    if (!result) throw std::runtime_error(result.error().message);
    return std::move(*result);
}

/// Writes `bytes` to the file `path`, or to standard output if `path` is "-". On failure, throws std::runtime_error.
void writeOutput(const std::string& path, std::string_view bytes);

/// Returns the part of the `--help` text that lists the options that describe a state.
std::string stateOptionsHelp();

}  // namespace oval4d
