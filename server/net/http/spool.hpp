#pragma once
// Keeps large replies on disk until clients have read them.

#include <string>

#include "net/ws/peer.hpp"

namespace oval4d::net {

/// Writes `bytes` to an unnamed temporary file and returns a memory mapping of that file, so that the system can evict
/// its pages when memory is scarce. The file is in `folder`, or in the system's temporary folder if `folder` is empty.
/// Less than 1 MiB of data stays in memory, as does all data if the file cannot be created or written.
Bytes spool(std::string bytes, const std::string& folder);

}  // namespace oval4d::net
