#pragma once
// Spools large replies to disk until clients have read them.

#include <string>

#include "net/ws/peer.hpp"

namespace oval4d::net {

/// Moves large data to an unnamed temporary file and returns a memory mapping of it, so that the system can evict its
/// pages under memory pressure. The file is in `folder`, or in the system's temporary folder if that is empty. Data
/// below 1 MiB, and all data if no file can be created, stays in memory.
Bytes spool(std::string bytes, const std::string& folder);

}  // namespace oval4d::net
