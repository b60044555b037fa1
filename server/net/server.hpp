#pragma once
// Runs the server.

#include "net/options.hpp"
#include "parallel/fork_join.hpp"
#include "process/heap.hpp"

namespace oval4d::net {

/// Listens and serves clients until SIGINT, SIGTERM or SIGHUP; then tells every client to reconnect later, writes the
/// sessions to the store, and returns. Throws an exception derived from std::exception if the server cannot start, for
/// example because it cannot listen.
void runServer(Options options, parallel::ForkJoin& forkJoin, process::Heap& heap);

}  // namespace oval4d::net
