#pragma once
// Keeps large replies on a disk until clients have read them.

#include <string>

#include "net/shared_bytes.hpp"

namespace oval4d::net {

/// Writes `bytes` to an unnamed temporary file, and returns a memory mapping of the file. When memory is scarce, the
/// system can evict the pages of the file. The file is in `folder`; an empty `folder` means the system's temporary
/// folder. Data of less than 1 MiB stay in memory, and so do larger data if the file cannot be written.
SharedBytes spool(std::string bytes, const std::string& folder);

}  // namespace oval4d::net
