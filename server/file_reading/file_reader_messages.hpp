#pragma once
// The messages between the server and its file reader processes, which read clients' files in a sandbox.

#include <cstddef>
#include <string>
#include <string_view>

#include "errors/error.hpp"
#include "fields/readers/file_contents.hpp"
#include "session/load.hpp"
#include "session/session.hpp"
#include "slicing/object_bytes.hpp"

namespace oval4d::file_reading {

/// A request to a file reader process to read a file, a series of files, or a folder.
struct FileReadRequest {
    session::LoadObject load;  ///< sent without its open files and folder, `dataName`, `continues` and `append`, and
                               ///< without FinerImageLevel::initialLevel
    std::size_t seriesLength = 0;  ///< the number of files of a series, or 0 if there is no series; the descriptor of
                                   ///< each file follows in a message of its own
    bool isFolder = false;         ///< whether to read a Zarr folder, whose files the process requests from the server
    bool mayMap = false;           ///< whether samples of more than maxFieldBytes are allowed; these stay in the file,
                                   ///< or are written to a new file that the server provides
    session::Limits limits;        ///< only maxVertices, maxHullCells, maxFieldBytes and maxFirstLevelBytes are sent
};

/// Encodes the FileReadRequest with the members `load`, `limits` and `mayMap`. Overwrites `out` with the bytes.
void encodeReadRequest(const session::LoadObject& load, const session::Limits& limits, bool mayMap, std::string& out);
/// Decodes the bytes that encodeReadRequest() wrote, and sets the members of `out`, which must be a new object. Throws
/// std::runtime_error if bytes are missing.
void decodeReadRequest(std::string_view bytes, FileReadRequest& out);

/// A message from a file reader process to the server, which requests a file of the folder that the process reads.
struct FolderFileRequest {
    std::string path;       ///< the path of the file, relative to the folder
    fields::FilePart part;  ///< the part of the file that the process needs
};
/// Encodes a FolderFileRequest. Overwrites `out` with the bytes.
void encodeFindRequest(const FolderFileRequest& request, std::string& out);
/// Decodes the result of encodeFindRequest(). The bytes need not be trusted: throws std::runtime_error if they are
/// invalid.
FolderFileRequest decodeFindRequest(std::string_view bytes);

/// Encodes the outcome of reading a file: an error, or the warnings and the data from which the object can be rebuilt.
/// Overwrites `out` with the bytes. `files` are mapped files, in the order in which the receiver maps them. An array
/// whose samples are in one of these files is encoded as a reference to the file if, otherwise, more than `maxInMemory`
/// samples would be encoded.
void encodeOutcome(const Result<session::ObjectWithWarnings>& outcome, std::string& out,
                   slicing::MappedFiles files = {}, std::size_t maxInMemory = fields::kMaxSamples);

/// Decodes the result of encodeOutcome(). `files` are the mapped files to which the bytes may refer. `bytes` need not
/// be trusted, because a malicious file may control the process that sent them. Returns a valid object named `name`
/// with a bounded number of printable warnings, or an error that can be sent to the client. Throws std::runtime_error
/// if the bytes are invalid.
Result<session::ObjectWithWarnings> decodeOutcome(std::string_view bytes, const std::string& name,
                                                  const session::Limits& limits,
                                                  const slicing::MappedFiles& files = {});

/// Returns the maximum number of bytes that encodeOutcome() writes for the file of `load`.
std::size_t maxOutcomeBytes(const session::LoadObject& load, const session::Limits& limits);

}  // namespace oval4d::file_reading
