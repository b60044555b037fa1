#pragma once
// `oval4d render`: one picture, without a server.

#include <string>

#include "session/query.hpp"

namespace CLI {
class App;
}

namespace oval4d {

struct RenderOptions {
    std::string output = "frame.png";  ///< "-" for standard output
    int width = 1280, height = 720;
};

/// Adds the options of the command to its `app`. Those that describe the state are left as `app.remaining()`.
void addRenderOptions(CLI::App& app, RenderOptions& options);

/// Draws the picture that `app` was given on the command line. Throws std::runtime_error, saying what is wrong.
void renderPicture(const CLI::App& app, const RenderOptions& options);

}  // namespace oval4d
