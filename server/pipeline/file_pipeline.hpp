#pragma once

#include <stop_token>
#include <string>

#include "errors/error.hpp"
#include "export/export.hpp"
#include "session/query.hpp"

namespace oval4d::pipeline {

/// Converts a session's state to the bytes of a file: state → slices → scene → file. Used by the server and the command
/// line. Errors: `no_body`, `too_large`, or `too_many` if `limits` leave no room for the file.
Result<std::string> fileOf(const session::State& state, const exports::ExportRequest& request,
                           const exports::Limits& limits, std::stop_token stop = {});

/// Removes "of", "body", "size" and "label" from `query` and returns the request that they describe. Errors:
/// `bad_message` or `out_of_range`, with the allowed values.
Result<exports::ExportRequest> takeExportRequest(session::Query& query, const exports::Format& format);

/// The suggested file name, in ASCII, such as "24-cell.stl".
std::string fileName(const session::State& state, const exports::ExportRequest& request);

}  // namespace oval4d::pipeline
