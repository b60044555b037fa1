#pragma once
// Files that only the server's own user can read and write.

#include <string>

namespace oval4d::store {

/// Throws StoreError if the path exists and is not a regular file of the server's own user: the owner of another file,
/// or of a symbolic link, could decide what the server reads and writes. Symbolic links among the parent folders are
/// the operator's, and are followed.
void refuseUnsafe(const std::string& path);

/// Creates `path` as an empty file of mode 0600, and its missing parent folders with mode 0700. An existing file is
/// given mode 0600, which is logged. Throws StoreError if that fails, or if refuseUnsafe does.
void makePrivate(const std::string& path);

/// Like makePrivate, but does nothing if the file does not exist.
void makePrivateIfExists(const std::string& path);

/// The device and inode of a file, which tell it from another of the same name; empty if the file does not exist.
std::string identityOf(const std::string& path);

}  // namespace oval4d::store
