#pragma once
// Lists the data folder for coroutines on the threads that serve sockets, without blocking these threads.

#include <boost/asio/awaitable.hpp>
#include <string>
#include <vector>

#include "net/clients.hpp"
#include "net/services.hpp"

namespace oval4d::net {

/// Returns the names of DataFolder::entryNames(). If the folder must be read, a load worker reads it, because the
/// folder may be on a slow disk or a network drive. Throws QueueFull if too many jobs are waiting.
boost::asio::awaitable<std::vector<std::string>> dataFolderNames(Services services, ClientAccountPtr client);

}  // namespace oval4d::net
