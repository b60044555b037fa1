#pragma once
// `oval4d export`: a slice or the oval as a file, without a server.

#include <string>

namespace CLI {
class App;
}

namespace oval4d {

struct ExportOptions {
    std::string output = "slice.stl";  ///< "-" for standard output
    std::string format;                ///< empty: by the extension of `output`
};

/// Adds the options of the command to its `app`. Those that describe the file and the state are left as
/// `app.remaining()`.
void addExportOptions(CLI::App& app, ExportOptions& options);

/// Writes the file that `app` was given on the command line. Throws std::runtime_error, saying what is wrong.
void exportFile(const CLI::App& app, const ExportOptions& options);

}  // namespace oval4d
