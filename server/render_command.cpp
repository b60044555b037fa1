#include "render_command.hpp"

#include <CLI/CLI.hpp>
#include <string_view>

#include "one_shot.hpp"
#include "picture/frame_limits.hpp"
#include "picture/painter.hpp"
#include "protocol/cpp/codec.hpp"

namespace oval4d {

void addRenderOptions(CLI::App& app, RenderOptions& options) {
    app.add_option("-o,--output", options.output, "The file to write, - for standard output")->capture_default_str();
    app.add_option("--width", options.width, "Pixels")->capture_default_str();
    app.add_option("--height", options.height, "Pixels")->capture_default_str();
    app.allow_extras();
    app.footer(kStateHelp);
}

void renderPicture(const CLI::App& app, const RenderOptions& options) {
    const auto viewport = valueOf(picture::checked({options.width, options.height}, {}));
    const auto state = stateOf(queryOf(app.remaining()));
    picture::Painter painter;
    std::vector<std::uint8_t> png;
    painter.frame(state, protocol::stateMessage(state, 0), viewport, png);
    writeOutput(options.output, {reinterpret_cast<const char*>(png.data()), png.size()});
}

}  // namespace oval4d
