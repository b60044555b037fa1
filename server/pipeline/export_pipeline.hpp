#pragma once

#include <stop_token>
#include <string>

#include "errors/error.hpp"
#include "export/export.hpp"
#include "session/query.hpp"

namespace oval4d::pipeline {

/// Exports what `request.contents` selects from a session's state (state → slices → scene → file). Used by the server
/// and the command line. Throws the exceptions of exports::exportScene(), and std::runtime_error if the samples of a
/// field are in a file that can no longer be read. Errors:
/// - `no_body` if there is nothing to export, if no body has room for its label, or if the format cannot contain what
///   is asked,
/// - `too_large` if the slices have more than ExportLimits::sliceEdges edges, if the file exceeds another limit or
///   takes too long, or if `stop` is requested,
/// - `too_many` if ExportLimits::grantTotalBytes refuses memory for the file,
/// - `bad_message` if the request gives both `at` and `fit`, or gives one of them for contents other than
///   ExportContentsKind::oval,
/// - `out_of_range` if two values of w in `at` are equal, if one of them is farther than session::kMaxOffset
///   circumradii from the w of ObjectInfo::originInFile, if `fit` is less than 1, if `at` or `fit` asks for more
///   than ExportLimits::slices, or if the size of a body or a drawing is outside its bounds.
Result<exports::ExportedFile> exportState(const session::State& state, const exports::ExportRequest& request,
                                          const exports::ExportLimits& limits, std::stop_token stop = {});

/// Removes the parameters "of", "body", "size", "label", "at", "fit" and "exact" from `query`, and returns the export
/// request that they describe. Missing parameters have their default values; with "at" or "fit", the default of "of" is
/// "oval". Errors whose messages list the allowed values: `bad_message` for an unknown value of "of", "body", "label"
/// or "exact"; `out_of_range` for a size that is not allowed, or if "fit" is not a whole number from 1 to `maxSlices`.
/// For "at" and "fit", also the errors of session::evaluate(). After an error, `query` must not be used.
Result<exports::ExportRequest> extractExportRequest(session::QueryParameters& query, const exports::Format& format,
                                                    int maxSlices);

/// Returns a suggested file name, such as "24-cell.stl": the name of the object, in which each byte that is not an
/// ASCII letter, a digit or - is replaced by _, and the name of the format.
std::string fileName(const session::State& state, const exports::ExportRequest& request);

}  // namespace oval4d::pipeline
