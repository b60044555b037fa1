#pragma once
// What the parts of the server share.

#include <boost/asio/io_context.hpp>

#include "net/metrics.hpp"
#include "net/options.hpp"
#include "net/worker_pool.hpp"
#include "protocol/cpp/error.hpp"

namespace oval4d::net {

/// Answers a request at which something failed that is not the client's.
inline const protocol::Error kFault{protocol::ErrorCode::internal,
                                    "the server failed to do this; the session is as it was"};

/// All of it outlives every connection and session.
struct Services {
    const Options& options;
    boost::asio::io_context& io;
    WorkerPool& pool;   ///< for pictures
    WorkerPool& files;  ///< for files, which take longer
    Metrics& metrics;
};

}  // namespace oval4d::net
