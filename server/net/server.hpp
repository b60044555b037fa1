#pragma once
// The function that runs the whole server until a signal stops it.

#include "net/server_options.hpp"
#include "parallel/fork_join.hpp"
#include "process/process_heap.hpp"

namespace oval4d::net {

/// Listens, and serves clients until SIGINT, SIGTERM or SIGHUP arrives. Then writes the sessions to the store, closes
/// all connections, and returns. WebSockets are closed with code 1012, so that clients reconnect at once, to this or
/// another server. Throws an exception derived from std::exception if the server cannot start, for example because it
/// cannot listen or the options contradict each other. For `forkJoin` and `heap`, see pipeline::PipelinePool.
void runServer(ServerOptions options, parallel::ForkJoin& forkJoin, process::ProcessHeap& heap);

}  // namespace oval4d::net
