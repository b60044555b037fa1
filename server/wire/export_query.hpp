#pragma once
// Reads the options of an export from the query of an address, or from the options of `oval4d export`.

#include <string>

#include "errors/error.hpp"
#include "export/export_request.hpp"
#include "session/query_text.hpp"

namespace oval4d::wire {

/// Removes the options of an export (those that exports::forEachOption() visits) from `query`. Returns the export
/// request that they describe. Options that are missing have their default values. The default of "of" is "oval" if the
/// query contains "at" or "fit". Errors, whose messages state what is allowed: `bad_message` for an unknown value of
/// "of", "body", "label" or "exact"; `out_of_range` for a size that is not allowed, or if "fit" is not a whole number
/// from 1 to `maxSlices`; for "at" and "fit", also the errors of session::evaluateNumber(). After an error, `query`
/// must not be used.
Result<exports::ExportRequest> extractExportRequest(session::QueryParameters& query, const exports::Format& format,
                                                    int maxSlices);

/// Returns the error `out_of_range` for a wrong value `given` of "fit", which must be a whole number from 1 to
/// `maxSlices`.
Error invalidFitError(int maxSlices, const std::string& given);

}  // namespace oval4d::wire
