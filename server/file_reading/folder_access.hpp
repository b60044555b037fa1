#pragma once

#include <string>

namespace oval4d::file_reading {

/// Opens a regular file below an open folder for reading. `folder` is the descriptor of the folder, and `path` is
/// relative to the folder. Returns the descriptor of the file, which the caller must close. Returns −1 if there is no
/// such file, if a component of `path` is empty, `.` or `..`, or if a component is a symbolic link.
int openBelow(int folder, const std::string& path);

}  // namespace oval4d::file_reading
