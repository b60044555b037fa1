#pragma once
// Files that only the server's own user can read and write.

#include <string>

namespace oval4d::store {

/// Throws StoreError if `path` exists and is not a regular file that the server's own user owns: the owner of another
/// file, or of a symbolic link, could determine what the server reads and writes. Follows symbolic links among the
/// parent folders, which the operator is responsible for.
void refuseUnsafe(const std::string& path);

/// Creates `path` as an empty file with mode 0600, and missing parent folders with mode 0700. If the file exists with
/// another mode, sets mode 0600 and logs this. Throws StoreError if that fails, or if the file is one that refuseUnsafe
/// rejects.
void makePrivate(const std::string& path);

/// Like makePrivate, but does nothing if the file does not exist.
void makePrivateIfExists(const std::string& path);

/// Returns the device and inode numbers of a file as text, which differ for another file with the same path. Returns an
/// empty text if the file does not exist.
std::string identityOf(const std::string& path);

}  // namespace oval4d::store
