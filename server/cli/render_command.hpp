#pragma once
// The subcommand `oval4d render`, which writes a picture as a PNG file. No running server is needed.

#include <string>

#include "parallel/fork_join.hpp"

#include "session/query.hpp"

namespace CLI {
class App;
}

namespace oval4d {

/// The options of `oval4d render` that say where to write the picture, and how large it is.
struct RenderOptions {
    std::string output = "frame.png";  ///< path of the file; "-" for standard output
    int width = 1280, height = 720;    ///< size of the picture in pixels
};

/// Adds the options --output, --width and --height to `app`, the parser of the subcommand. The parser stores their
/// values in `options`. After parsing, `app.remaining()` returns the options that describe the state to draw.
void addRenderOptions(CLI::App& app, RenderOptions& options);

/// Writes the picture that the parsed command line describes, with the threads of `forkJoin`. On failure, throws
/// std::runtime_error with a message for the user.
void renderPicture(const CLI::App& app, const RenderOptions& options, parallel::ForkJoin& forkJoin);

}  // namespace oval4d
