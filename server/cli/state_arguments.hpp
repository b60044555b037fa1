#pragma once
// Functions for the subcommands `render` and `export`, which write one file from a state given on the command line.

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
/// order of the arguments. Throws std::runtime_error if an argument does not begin with "--" or lacks a value.
session::QueryParameters queryOf(const std::vector<std::string>& words);

/// Returns the state that the query describes. The query parameter "load" is the path of what to show: a file with an
/// object, a Zarr folder, a folder with a series of files (see fields::readSeries()), a file with a `state` message, or
/// a picture made by oval4d. The other parameters change a state: the one in the message or picture, else the initial
/// state, with the object in the file if "load" is the path of an object. For an array, "axes", "box", "region",
/// "variable", "values" and "values_variable" say how to read it; for a polytope, a surface or a list of points,
/// "center" is the point about which the object turns. Prints warnings about the file to standard error. `others` are
/// the names of further options that the subcommand allows; the error message about an unknown option lists them, too.
/// Throws std::runtime_error with a message for the user.
session::State loadState(session::QueryParameters query, std::span<const std::string_view> others);

/// Returns the value, or throws the error's message as a std::runtime_error.
template <typename T>
T valueOrThrow(Result<T> result) {
    if (!result) throw std::runtime_error(result.error().message);
    return std::move(*result);
}

/// Writes `bytes` to the file `path`, or to standard output if `path` is "-". Throws std::runtime_error if that fails.
void writeOutput(const std::string& path, std::string_view bytes);

/// Returns the part of the `--help` text about the options that describe a state.
std::string stateHelp();

}  // namespace oval4d
