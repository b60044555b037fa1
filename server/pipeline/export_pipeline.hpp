#pragma once

#include <stop_token>
#include <string>

#include "errors/error.hpp"
#include "export/export.hpp"
#include "session/query.hpp"

namespace oval4d::pipeline {

/// Exports what `request.extent` selects from a session's state (state → slices → scene → file), and returns the bytes
/// of the file. Used by the server and the command line. Errors: `no_body` if there is nothing to export; `too_large`
/// if the file exceeds a limit or takes too long, or if `stop` is requested; `too_many` if ExportLimits::reserve
/// refuses memory for the file.
Result<std::string> exportState(const session::State& state, const exports::ExportRequest& request,
                                const exports::ExportLimits& limits, std::stop_token stop = {});

/// Removes the parameters "of", "body", "size" and "label" from `query`, and returns the export request that they
/// describe. Missing parameters have their default values. Errors: `bad_message` for an unknown value; `out_of_range`
/// for a size that is not allowed. The error messages list the allowed values.
Result<exports::ExportRequest> extractExportRequest(session::QueryParameters& query, const exports::Format& format);

/// Returns a suggested file name: the name of the object, with unusual characters replaced by _, such as "24-cell.stl".
std::string fileName(const session::State& state, const exports::ExportRequest& request);

}  // namespace oval4d::pipeline
