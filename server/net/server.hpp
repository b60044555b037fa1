#pragma once
// The server: listens, serves clients, and shuts down.

#include "net/options.hpp"
#include "parallel/fork_join.hpp"
#include "process/heap.hpp"

namespace oval4d::net {

/// Listens and serves clients until SIGINT, SIGTERM or SIGHUP, then tells every client to reconnect later and returns.
/// Throws std::exception if it cannot listen.
void runServer(Options options, parallel::ForkJoin& forkJoin, process::Heap& heap);

}  // namespace oval4d::net
