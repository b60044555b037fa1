#pragma once
// The main function of a process that reads a file for the server.

#include "process/sandbox.hpp"

namespace oval4d::file_reading {

/// The subcommand of this program that runs it as a reader process.
inline constexpr const char* kFileReaderCommand = "read";

/// Confines this process to a sandbox, receives one file over `socket`, sends back the object in the file or an error,
/// and returns.
void runFileReader(int socket, const process::Confinement& confinement);

}  // namespace oval4d::file_reading
