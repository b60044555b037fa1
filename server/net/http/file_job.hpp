#pragma once
// The job that makes a file for export on a worker.

#include <functional>
#include <optional>

#include "net/services.hpp"
#include "net/ws/peer.hpp"
#include "pipeline/file_pipeline.hpp"

namespace oval4d::net {

/// The file, or an error; empty only until the job is done.
using FileResult = std::optional<Result<Bytes>>;

/// Returns a job that makes the requested file. The bytes of the file are reserved on the client's byte account until
/// the last reference to them is destroyed. The error is `too_many` if the account has no room for them.
std::function<FileResult(std::size_t worker)> fileJob(Services services, const session::State& state,
                                                      const exports::ExportRequest& request, const ClientPtr& client);

}  // namespace oval4d::net
