#pragma once

#include <filesystem>

namespace oval4d::net {

/// Creates an unnamed file in `folder`, open for reading and writing. Returns the file's descriptor. On failure,
/// returns −1 and sets errno. The system deletes the file when its last descriptor and its last memory mapping are
/// gone.
int openUnnamedFile(const std::filesystem::path& folder);

}  // namespace oval4d::net
