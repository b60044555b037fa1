#pragma once

#include <filesystem>

namespace oval4d::net {

/// Creates an unnamed file in `folder`, open for reading and writing. The system deletes the file when nothing refers
/// to it anymore. Returns the file's descriptor. On failure, returns −1 and sets errno.
int openUnnamedFile(const std::filesystem::path& folder);

}  // namespace oval4d::net
