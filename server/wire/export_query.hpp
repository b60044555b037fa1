#pragma once
// The options of an export in the query of an address, or in the options of `oval4d export`.

#include <string>

#include "errors/error.hpp"
#include "export/export_request.hpp"
#include "session/query_text.hpp"

namespace oval4d::wire {

/// Removes the options that exports::forEachOption() visits from `query`, and returns the export request that they
/// describe. Missing parameters have their default values; with "at" or "fit", the default of "of" is "oval". Errors
/// whose messages list the allowed values: `bad_message` for an unknown value of "of", "body", "label" or "exact";
/// `out_of_range` for a size that is not allowed, or if "fit" is not a whole number from 1 to `maxSlices`. For "at" and
/// "fit", also the errors of session::evaluate(). After an error, `query` must not be used.
Result<exports::ExportRequest> extractExportRequest(session::QueryParameters& query, const exports::Format& format,
                                                    int maxSlices);

/// Returns the error `out_of_range`, which says that "fit" must be a whole number from 1 to `maxSlices`, and not
/// `given`.
Error wrongFit(int maxSlices, const std::string& given);

}  // namespace oval4d::wire
