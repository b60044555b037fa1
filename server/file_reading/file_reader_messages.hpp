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
    std::size_t seriesLength = 0;  ///< the number of files of a series; each descriptor follows in its own
                                   ///< message
    bool isFolder = false;         ///< whether to read a Zarr folder, whose files the process requests from the server
    bool mayMap = false;           ///< whether the samples of large arrays may stay in the file or be written to a new
                                   ///< file
    session::Limits limits;        ///< only maxVertices, maxHullCells, maxFieldBytes and maxFirstLevelBytes are sent
};

/// Encodes a FileReadRequest for the file of `load` within `limits`, and writes it to `out`. For `mayMap`, see
/// FileReadRequest::mayMap.
void encodeReadRequest(const session::LoadObject& load, const session::Limits& limits, bool mayMap, std::string& out);
/// Decodes the result of encodeReadRequest() into `out`. Throws std::runtime_error if bytes are missing.
void decodeReadRequest(std::string_view bytes, FileReadRequest& out);

/// A request of a file reader process for a file of the folder that it reads.
struct FolderFileRequest {
    std::string path;       ///< the path of the file, relative to the folder
    fields::FilePart part;  ///< the part of the file that the process needs
};
/// Encodes a FolderFileRequest, and writes it to `out`.
void encodeFindRequest(const FolderFileRequest& request, std::string& out);
/// Decodes the result of encodeFindRequest(). The bytes need not be trusted: throws std::runtime_error if they are
/// invalid.
FolderFileRequest decodeFindRequest(std::string_view bytes);

/// Encodes the outcome of reading a file: an error, or the warnings and the data from which the object can be rebuilt.
/// Overwrites `out`. `files` are mapped files, in the order in which the receiver maps them. An array with more than
/// `maxInMemory` samples that is in one of these files is encoded as a reference to the file.
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
