#pragma once

#include <string>

namespace oval4d::file_reading {

/// Opens a regular file below an open folder to read it. `folder` is the descriptor of the folder. `path` is relative
/// to it, without empty components, `.` and `..`; symbolic links are not followed. Returns the descriptor of the file,
/// which the caller must close, or -1 if there is no such file.
int openBelow(int folder, const std::string& path);

}  // namespace oval4d::file_reading
