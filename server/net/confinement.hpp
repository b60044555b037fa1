#pragma once
// The sandbox and memory limits of the server's child processes.

#include <cstddef>
#include <string>
#include <vector>

#include "net/server_options.hpp"
#include "process/sandbox.hpp"

namespace oval4d::net {

/// Returns the environment variables through which the server passes its options to child processes
/// (process::ChildOptions::environment). `workers`: the number of picture workers. Unless the options turn the sandbox
/// off, checks whether the system can sandbox child processes. If the system cannot, sets `warning` to a message for
/// the log, or throws std::runtime_error if the options require a sandbox.
std::vector<std::string> childEnvironment(const ServerOptions& options, std::size_t workers, std::string& warning);

/// Returns the confinement that a rasterizer process applies to itself. `options` must have been read from the
/// variables that childEnvironment() has returned.
process::Confinement rasterizerConfinement(const ServerOptions& options);
/// Returns the confinement that a file reader process applies to itself. `options` must have been read from the
/// variables that childEnvironment() has returned.
process::Confinement fileReaderConfinement(const ServerOptions& options);

}  // namespace oval4d::net
