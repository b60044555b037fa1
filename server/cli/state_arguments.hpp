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

/// The part of the `--help` text about the options that describe a state.
inline constexpr const char* kStateHelp =
    "All other options describe the state, as for :set and the query of frame.png:\n"
    "  --polytope 24-cell --rotate xw,yz:pi/8,pi/sqrt(3)-pi/8 --slices 31 --view single --background white\n"
    "--load FILE shows a polytope or a surface from a 4OFF file, the points of a file whose first word is CLOUD,\n"
    "a field from an array (npy, netcdf, hdf5, nifti, a Zarr folder, or a folder with one such file for each\n"
    "moment; with --axes tzyx --box X0,X1,Y0,Y1,Z0,Z1,W0,W1 --variable NAME), or the convex hull of any\n"
    "other list of points. --region, with numbers as --box, reads a part of a Zarr folder.\n"
    "--values FORMULA, or for arrays --values_variable NAME, is a second function whose values color the surfaces.\n"
    "--center object|origin|X,Y,Z,W is the point about which a polytope, a surface or points turn.\n"
    "A picture that oval4d has made, or a state as JSON, is shown again; other options change it.\n"
    "--rotate may be repeated; the rotations are applied in the order given.";

}  // namespace oval4d
