#pragma once
// The sandbox and the memory limits of the server's child processes.

#include <cstddef>
#include <string>
#include <vector>

#include "net/server_options.hpp"
#include "process/sandbox.hpp"

namespace oval4d::net {

/// Returns the environment variables that pass the server's options to child processes
/// (process::ChildOptions::environment). `workers` is the number of picture workers. Unless the options turn the
/// sandbox off, checks whether the system can sandbox child processes. If it cannot, sets `warning` to a message for
/// the log; throws std::runtime_error if the options require a sandbox.
std::vector<std::string> childEnvironment(const ServerOptions& options, std::size_t workers, std::string& warning);

/// Returns the limits that a rasterizer process, which draws pictures, applies to itself. `options` must have been
/// parsed from the environment variables that childEnvironment() returned.
process::Confinement rasterizerConfinement(const ServerOptions& options);
/// Returns the limits that a file reader process, which parses clients' files, applies to itself. `options` must have
/// been parsed from the environment variables that childEnvironment() returned.
process::Confinement fileReaderConfinement(const ServerOptions& options);

}  // namespace oval4d::net
