#pragma once
// The subcommand `oval4d export`: writes a slice or the oval as a file, without a server.

#include <string>

namespace CLI {
class App;
}

namespace oval4d {

struct ExportOptions {
    std::string output = "slice.stl";  ///< "-" for standard output
    std::string format;                ///< empty: from the extension of `output`
};

/// Adds the options of the subcommand to its `app`. Options that describe the file and the state remain in
/// `app.remaining()`.
void addExportOptions(CLI::App& app, ExportOptions& options);

/// Writes the file that the parsed command line describes. Throws std::runtime_error with a message for the user.
void exportFile(const CLI::App& app, const ExportOptions& options);

}  // namespace oval4d
