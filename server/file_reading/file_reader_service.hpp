#pragma once
// The main function of a process that reads a file for the server.

#include "process/sandbox.hpp"

namespace oval4d::file_reading {

/// The subcommand with which this program runs as a reader process.
inline constexpr const char* kFileReaderCommand = "read";

/// Confines this process to a sandbox, receives the request for one file over `socket`, answers with the object in the
/// file or with an error, and returns.
void runFileReader(int socket, const process::Confinement& confinement);

}  // namespace oval4d::file_reading
