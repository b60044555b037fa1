#pragma once
// Messages between the server and its reader processes.

#include <cstddef>
#include <string>
#include <string_view>

#include "errors/error.hpp"
#include "session/load.hpp"
#include "session/session.hpp"

namespace oval4d::file_reading {

/// A file to read: its format (see session::readObject), the name for the object in it, and its text.
struct File {
    std::string format, name, text;
    session::Limits limits;  ///< only maxVertices and maxHullCells are sent
};

/// Encodes a file and the limits to read it with. Overwrites `out`.
void encodeFile(std::string_view format, std::string_view text, const std::string& name, const session::Limits& limits,
                std::string& out);
/// Decodes the bytes of `encodeFile` into `out`. Throws std::runtime_error if bytes are missing.
void decodeFile(std::string_view bytes, File& out);

/// Encodes the result of reading a file. This is an error, or else the warnings and the data from which the object can
/// be rebuilt (see slicing::writeParts). Overwrites `out`.
void encodeOutcome(const Result<session::LoadedObject>& outcome, std::string& out);

/// Decodes the bytes of `encodeOutcome`. They need not be trusted: a malicious file may control the process that sent
/// them. Returns a valid object called `name` with a bounded number of printable warnings, or an error about the file
/// that can be sent to the client. Throws std::runtime_error if the bytes are invalid.
Result<session::LoadedObject> decodeOutcome(std::string_view bytes, const std::string& name,
                                            const session::Limits& limits);

/// Returns the maximum size in bytes of the encoded outcome of reading a text of `textBytes` bytes.
std::size_t maxOutcomeBytes(std::size_t textBytes, const session::Limits& limits);

}  // namespace oval4d::file_reading
