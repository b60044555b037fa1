#pragma once
// The subcommand `oval4d export`, which writes a file for other programs, such as a drawing or a slice for 3-D
// printing. No running server is needed. The option --of chooses the content (see exports::ExportContentsKind).

#include <string>

namespace CLI {
class App;
}

namespace oval4d {

/// The options of `oval4d export` that say where to write the file, and in which format.
struct ExportOutputOptions {
    std::string output = "slice.stl";  ///< path of the file; "-" for standard output
    std::string format;                ///< name of the file format; if empty, the extension of `output` determines the
                                       ///< format
};

/// Adds the options --output and --format to `app`, the parser of the subcommand. The parser stores their values in
/// `options`. After parsing, `app.remaining()` returns the options that describe the state and the content of the file.
void addExportOptions(CLI::App& app, ExportOutputOptions& options);

/// Writes the file that the parsed command line describes, and prints warnings about the file to standard error. On
/// failure, throws std::runtime_error with a message for the user.
void exportFile(const CLI::App& app, const ExportOutputOptions& options);

}  // namespace oval4d
