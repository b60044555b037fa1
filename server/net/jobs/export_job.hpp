#pragma once
// A job that makes an exported file on a worker.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "net/clients.hpp"
#include "net/services.hpp"
#include "net/shared_bytes.hpp"
#include "pipeline/export_pipeline.hpp"

namespace oval4d::net {

/// An exported file, and the warnings about it (see exports::ExportedFile).
struct FinishedExport {
    SharedBytes bytes;
    std::vector<std::string> warnings;
};

/// The result of an export job: the file or an error. Empty only until the job is done.
using ExportResult = std::optional<Result<FinishedExport>>;

/// Returns a job that makes the requested file. The file's bytes stay reserved on the client's byte account until the
/// last copy of FinishedExport::bytes is destroyed. Errors of the job: those of pipeline::exportFile(), of which
/// `too_many` means that the byte account has no room for the file.
std::function<ExportResult(std::size_t worker)> exportJob(Services services, const scene::PictureRequest& picture,
                                                          const exports::ExportRequest& request,
                                                          const ClientAccountPtr& client);

}  // namespace oval4d::net
