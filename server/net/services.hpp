#pragma once
// The services that connections and sessions share, and errors that both send to clients.

#include <boost/asio/io_context.hpp>

#include "errors/error.hpp"
#include "file_reading/file_reader_pool.hpp"
#include "net/clients.hpp"
#include "net/clock.hpp"
#include "net/data_folder.hpp"
#include "net/field_cache_files.hpp"
#include "net/metrics.hpp"
#include "net/server_options.hpp"
#include "parallel/worker_pool.hpp"
#include "pipeline/pipeline_pool.hpp"
#include "polytopes/catalogue/polytope_cache.hpp"
#include "slicing/critical/critical_sections_cache.hpp"

namespace oval4d::net {

/// The error for a request that failed because of a fault of the server.
inline const Error kInternalError{ErrorCode::internal,
                                  "the server failed to carry out this request; the session is unchanged"};

/// The error for a request that would exceed the byte limit (ByteBudget) of the client or of all clients together.
inline const Error kTooManyBytes{
    ErrorCode::too_many,
    "the server already holds as many bytes as it may for this client, or for all clients: unread files and pictures, "
    "polytopes loaded or built by name, and undo history (--max-client-bytes, --max-bytes); try again when some of "
    "them have been freed"};

/// The error for a request whose job was rejected because the job queue is full (parallel::QueueFull).
inline const Error kTooManyJobs{ErrorCode::too_many,
                                "too many pictures and files are waiting for a worker; try again later"};

/// References to the shared services. The services outlive every connection and session.
struct Services {
    const ServerOptions& options;
    boost::asio::io_context& io;
    pipeline::PipelinePool& pictureWorkers;  ///< threads that slice and draw pictures
    parallel::WorkerPool& exportWorkers;     ///< threads that make exported files (slower than pictures)
    Metrics& metrics;
    ClientAccounts& clients;
    /// Threads for work that waits for files: reading uploads, reading and listing arrays of the data folder, and
    /// decoding stored sessions that refer to such arrays.
    parallel::WorkerPool& loadWorkers;
    file_reading::FileReaderPool& readers;     ///< the file reader processes
    polytopes::PolytopeCache& polytopes;       ///< polytopes that were built from their names
    DataFolder& data;                          ///< the arrays that the server offers
    const FieldCacheFiles& fieldCacheFiles;    ///< files with the converted samples of large arrays in `data`
    slicing::CriticalSectionsCache& critical;  ///< cached results of searches for critical values of w
    const TimerClock& clock;                   ///< the clock of pictures, saves, deadlines and rate limits
};

}  // namespace oval4d::net
