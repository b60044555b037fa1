#pragma once

#include <filesystem>

namespace oval4d::net {

/// Opens an unnamed file for reading and writing, which the system deletes when nothing refers to it anymore. Returns
/// its descriptor; if that fails, returns −1 and sets errno.
int openUnnamedFile(const std::filesystem::path& folder);

}  // namespace oval4d::net
