#pragma once
// Keeps large replies on disk until clients have read them.

#include <string>

#include "net/shared_bytes.hpp"

namespace oval4d::net {

/// Writes `bytes` to an unnamed temporary file and returns a memory mapping of that file, so that the system can evict
/// its pages when memory is scarce. The file is in `folder`, or in the system's temporary folder if `folder` is empty.
/// Data of less than 1 MiB stays in memory. Larger data also stays in memory if the file cannot be created or written.
SharedBytes spool(std::string bytes, const std::string& folder);

}  // namespace oval4d::net
