#pragma once
// The sandbox and memory limits of the server's child processes.

#include <cstddef>
#include <string>
#include <vector>

#include "net/options.hpp"
#include "process/sandbox.hpp"

namespace oval4d::net {

/// The environment variables by which the server passes its options to child processes
/// (process::ChildOptions::environment). Checks whether the system can sandbox them. If it cannot, sets `warning` for
/// the log, unless the options turn the sandbox off, and throws std::runtime_error if the options require a sandbox.
std::vector<std::string> childEnvironment(const Options& options, std::size_t workers, std::string& warning);

/// The confinement that a rasterizer process applies to itself, given the options read from that environment.
process::Confinement rasterizerConfinement(const Options& options);
/// The confinement that a file reader process applies to itself, given the options read from that environment.
process::Confinement readingConfinement(const Options& options);

}  // namespace oval4d::net
