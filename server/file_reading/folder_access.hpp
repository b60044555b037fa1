#pragma once

#include <string>

namespace oval4d::file_reading {

/// Opens a regular file below an open folder to read it. `path` is relative, without empty components, `.` and `..`;
/// symbolic links are not followed. Returns its descriptor, or -1 if there is no such file.
int openBelow(int folder, const std::string& path);

}  // namespace oval4d::file_reading
