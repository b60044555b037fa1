#pragma once
// The server as a whole.

#include "net/options.hpp"

namespace oval4d::net {

/// Listens, serves, and returns after SIGINT or SIGTERM, once every client has been told to come back later. Throws
/// std::exception if it cannot listen.
void runServer(Options options);

}  // namespace oval4d::net
