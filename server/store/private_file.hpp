#pragma once
// Creates and checks files that only the user of the server process can read and write.

#include <string>

namespace oval4d::store {

/// Throws StoreError if `path` exists, unless it is a regular file that the user of this process owns. Without this
/// check, another user could control what the server reads and writes, by owning the file or by a symbolic link at
/// `path`. Does not check the parent folders; symbolic links among them are allowed.
void requireOwnRegularFileIfExists(const std::string& path);

/// Creates the empty file `path` with mode 0600, and its missing parent folders with mode 0700. If the file exists with
/// another mode, sets mode 0600 and logs the change. Throws StoreError if a step fails, or if
/// requireOwnRegularFileIfExists() would throw.
void ensurePrivateFile(const std::string& path);

/// Sets the mode of the file `path` to 0600, and logs the change. Does nothing if the file does not exist. Throws the
/// same errors as ensurePrivateFile().
void makePrivateIfExists(const std::string& path);

/// Returns the device and inode numbers of the file `path` as text. They change if another file replaces the file.
/// Returns an empty string if there is no such file.
std::string fileIdentity(const std::string& path);

}  // namespace oval4d::store
