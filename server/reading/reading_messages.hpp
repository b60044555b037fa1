#pragma once
// Messages between the server and its reader processes.

#include <cstddef>
#include <string>
#include <string_view>

#include "errors/error.hpp"
#include "session/load.hpp"
#include "session/session.hpp"

namespace oval4d::reading {

/// A file to read.
struct File {
    std::string format, name, text;
    session::Limits limits;  ///< only maxVertices and maxHullCells are sent
};

/// Encodes a file and the limits to read it with. Overwrites `out`.
void encodeFile(std::string_view format, std::string_view text, const std::string& name, const session::Limits& limits,
                std::string& out);
/// Throws std::runtime_error if bytes are missing.
void decodeFile(std::string_view bytes, File& out);

/// Encodes the result of reading a file; of an object, what it is built from. Overwrites `out`.
void encodeOutcome(const Result<session::LoadedObject>& outcome, std::string& out);

/// Decodes untrusted bytes: the result is a valid object called `name`, with a bounded number of printable warnings, or
/// an error about the file that can be sent to the client. Throws std::runtime_error for anything else.
Result<session::LoadedObject> decodeOutcome(std::string_view bytes, const std::string& name,
                                            const session::Limits& limits);

/// The maximum size in bytes of the outcome of reading a text of `textBytes` bytes.
std::size_t maxOutcomeBytes(std::size_t textBytes, const session::Limits& limits);

}  // namespace oval4d::reading
