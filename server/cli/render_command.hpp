#pragma once
// The subcommand `oval4d render`: writes one picture as a PNG file. It needs no running server.

#include <string>

#include "parallel/fork_join.hpp"

#include "session/query.hpp"

namespace CLI {
class App;
}

namespace oval4d {

/// The options of `oval4d render` that say where to write the picture and how large it is.
struct RenderOptions {
    std::string output = "frame.png";  ///< "-" for standard output
    int width = 1280, height = 720;    ///< pixels
};

/// Adds the options --output, --width and --height to `app`, the parser of the subcommand, which stores their values in
/// `options`. After parsing, `app.remaining()` contains the options that describe the state.
void addRenderOptions(CLI::App& app, RenderOptions& options);

/// Writes the picture that the parsed command line describes. If this fails, throws std::runtime_error with a message
/// for the user.
void renderPicture(const CLI::App& app, const RenderOptions& options, parallel::ForkJoin& forkJoin);

}  // namespace oval4d
