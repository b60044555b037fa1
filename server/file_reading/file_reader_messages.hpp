#pragma once
// Messages between the server and its file reader processes.

#include <cstddef>
#include <string>
#include <string_view>

#include "errors/error.hpp"
#include "fields/readers/file_contents.hpp"
#include "session/load.hpp"
#include "session/session.hpp"
#include "slicing/object_bytes.hpp"

namespace oval4d::file_reading {

/// What a file reader process must read.
struct ReadRequest {
    session::LoadObject load;  ///< sent without its open files and folder, `dataName`, `continues` and `append`, and
                               ///< without FinerLevel::initialLevel
    std::size_t seriesLength = 0;  ///< the number of files of a series; further messages carry their descriptors
    bool isFolder = false;         ///< whether a Zarr folder is read; the reader process asks the server for its files
    bool mayMap = false;           ///< whether the samples of large arrays may stay in the file or go to a new one
    session::Limits limits;        ///< only maxVertices, maxHullCells, maxFieldBytes and maxFirstLevelBytes are sent
};

/// Encodes a request to read the file of `load` within `limits`, and writes it to `out`. `mayMap`: see
/// ReadRequest::mayMap.
void encodeReadRequest(const session::LoadObject& load, const session::Limits& limits, bool mayMap, std::string& out);
/// Decodes the bytes of encodeReadRequest() into `out`. Throws std::runtime_error if bytes are missing.
void decodeReadRequest(std::string_view bytes, ReadRequest& out);

/// A request of a reader process for a file in the folder that it reads.
struct FindRequest {
    std::string path;       ///< relative to the folder
    fields::FilePart part;  ///< what the process needs of the file
};
/// Encodes a request for a file, and writes it to `out`.
void encodeFindRequest(const FindRequest& request, std::string& out);
/// Decodes the bytes of encodeFindRequest(), which need not be trusted. Throws std::runtime_error if they are invalid.
FindRequest decodeFindRequest(std::string_view bytes);

/// Encodes the result of reading a file: an error, or the warnings and the data from which the object can be rebuilt.
/// `files` are mapped files, in the order in which the receiver maps them. An array in a mapped file is encoded as a
/// reference to the file if otherwise more than `maxInMemory` samples would be encoded. Overwrites `out`.
void encodeOutcome(const Result<session::ObjectWithWarnings>& outcome, std::string& out,
                   slicing::MappedFiles files = {}, std::size_t maxInMemory = fields::kMaxSamples);

/// Decodes the result of encodeOutcome(). `files` are the mapped files to which the bytes may refer. `bytes` need not
/// be trusted: a malicious file may control the process that sent them. Returns a valid object called `name` with a
/// bounded number of printable warnings, or an error about the file that can be sent to the client. Throws
/// std::runtime_error if the bytes are invalid.
Result<session::ObjectWithWarnings> decodeOutcome(std::string_view bytes, const std::string& name,
                                                  const session::Limits& limits,
                                                  const slicing::MappedFiles& files = {});

/// Returns the maximum number of bytes that encodeOutcome() writes for the file of `load`.
std::size_t maxOutcomeBytes(const session::LoadObject& load, const session::Limits& limits);

}  // namespace oval4d::file_reading
