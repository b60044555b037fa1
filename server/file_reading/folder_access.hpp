#pragma once

#include <string>

namespace oval4d::file_reading {

/// Opens a regular file for reading. `folder` is the descriptor of an open folder, and `path` is the path of the file
/// relative to this folder. Returns the descriptor of the file, which the caller must close. Returns −1 if the file
/// cannot be opened or is not a regular file, if a name in `path` is empty, `.` or `..`, or if the file or a folder in
/// `path` is a symbolic link.
int openFileWithin(int folder, const std::string& path);

}  // namespace oval4d::file_reading
