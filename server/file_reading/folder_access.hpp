#pragma once

#include <string>

namespace oval4d::file_reading {

/// Opens a regular file for reading, in an open folder or in a folder within it. `folder` is the descriptor of the
/// folder; `path` is relative to the folder. Returns the descriptor of the file, which the caller must close. Returns
/// −1 if there is no such file, if a name in `path` is empty, `.` or `..`, or if a file or folder on the path is a
/// symbolic link.
int openFileWithin(int folder, const std::string& path);

}  // namespace oval4d::file_reading
