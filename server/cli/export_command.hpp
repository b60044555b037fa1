#pragma once
// The subcommand `oval4d export`: writes a file for other programs, such as a solid body of a slice or a drawing. It
// needs no running server. The option --of chooses the content (see exports::ExportContentsKind).

#include <string>

namespace CLI {
class App;
}

namespace oval4d {

/// The options of `oval4d export` that say where to write the file and in which format.
struct ExportOutputOptions {
    std::string output = "slice.stl";  ///< "-" for standard output
    std::string format;                ///< name of the file format; if empty, the extension of `output` determines it
};

/// Adds the options --output and --format to `app`, the parser of the subcommand, which stores their values in
/// `options`. After parsing, `app.remaining()` contains the options that describe the state and the content of the
/// file.
void addExportOptions(CLI::App& app, ExportOutputOptions& options);

/// Writes the file that the parsed command line describes. If this fails, throws std::runtime_error with a message for
/// the user.
void exportFile(const CLI::App& app, const ExportOutputOptions& options);

}  // namespace oval4d
