#pragma once
// The services that connections and sessions share, and the errors that they all send.

#include <boost/asio/io_context.hpp>

#include "errors/error.hpp"
#include "net/clients.hpp"
#include "net/metrics.hpp"
#include "net/options.hpp"
#include "parallel/worker_pool.hpp"
#include "pipeline/pipeline_pool.hpp"
#include "polytopes/catalogue/polytope_cache.hpp"
#include "reading/file_readers.hpp"

namespace oval4d::net {

/// The reply to a request that failed through no fault of the client.
inline const Error kInternalError{ErrorCode::internal,
                                  "the server failed to carry out this request; the session is unchanged"};

/// The reply to a request that would exceed the byte limit of the client, or of all clients together.
inline const Error kTooManyBytes{
    ErrorCode::too_many,
    "the server already holds as many bytes as it may for this client, or for all clients: unread files and pictures, "
    "polytopes loaded or built by name, and undo history (--max-client-bytes, --max-bytes); try again when some of "
    "them have been freed"};

/// The reply to a request whose job was refused with QueueFull.
inline const Error kTooManyJobs{ErrorCode::too_many,
                                "too many pictures and files are waiting for a worker; try again later"};

/// References to the shared services. They outlive every connection and session.
struct Services {
    const Options& options;
    boost::asio::io_context& io;
    pipeline::PipelinePool& pictureWorkers;  ///< draws pictures
    parallel::WorkerPool& fileWorkers;       ///< makes files, which takes longer
    Metrics& metrics;
    Clients& clients;
    parallel::WorkerPool& loadWorkers;  ///< for files that clients load: its threads wait for the reader processes
    reading::FileReaders& readers;
    polytopes::PolytopeCache& polytopes;
};

}  // namespace oval4d::net
