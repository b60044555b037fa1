#pragma once
// The main function of a file reader process, which reads a file for the server.

#include "process/sandbox.hpp"

namespace oval4d::file_reading {

/// The subcommand that makes this program run as a file reader process.
inline constexpr const char* kFileReaderCommand = "read";

/// Confines this process to a sandbox, receives a FileReadRequest, sends the object that was read, or an error, and
/// returns. `socket` is the descriptor of the socket to the server. If the sandbox cannot be set up, sends
/// MessageType::failed instead and returns.
void runFileReader(int socket, const process::Confinement& confinement);

}  // namespace oval4d::file_reading
