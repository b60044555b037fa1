#pragma once
// The main function of a process that reads a file for the server.

#include "process/sandbox.hpp"

namespace oval4d::reading {

/// The subcommand that starts the program as such a process.
inline constexpr const char* kReadingCommand = "read";

/// Confines this process, receives one file through `socket`, sends the object in it or an error, and returns.
void serveReading(int socket, const process::Confinement& confinement);

}  // namespace oval4d::reading
