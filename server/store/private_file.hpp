#pragma once
// Files that only the server's own user can read and write.

#include <string>

namespace oval4d::store {

/// Throws StoreError if `path` exists and is not a regular file that the server's own user owns. The owner of any other
/// file, or of a symbolic link at `path`, could determine what the server reads and writes. Symbolic links among the
/// parent folders are followed: the operator is responsible for these folders.
void requireOwnRegularFileIfExists(const std::string& path);

/// Creates `path` as an empty file with mode 0600, and missing parent folders with mode 0700. If the file exists with
/// another mode, sets mode 0600 and logs this. Throws StoreError if one of these steps fails, or if
/// requireOwnRegularFileIfExists() would throw.
void ensurePrivateFile(const std::string& path);

/// Like ensurePrivateFile(), but does nothing if the file does not exist.
void makePrivateIfExists(const std::string& path);

/// Returns the device and inode numbers of a file, as a string that changes if another file replaces the one at `path`.
/// Returns an empty string if the file does not exist.
std::string fileIdentity(const std::string& path);

}  // namespace oval4d::store
