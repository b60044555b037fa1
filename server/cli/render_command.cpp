#include "cli/render_command.hpp"

#include <CLI/CLI.hpp>
#include <limits>
#include <memory>
#include <string_view>

#include "cli/state_arguments.hpp"
#include "pipeline/frame_limits.hpp"
#include "pipeline/pipeline.hpp"
#include "session/picture.hpp"
#include "wire/state_message.hpp"

namespace oval4d {

void addRenderOptions(CLI::App& app, RenderOptions& options) {
    app.add_option("-o,--output", options.output, "The file to write, - for standard output")->capture_default_str();
    app.add_option("--width", options.width, "The width of the picture in pixels")->capture_default_str();
    app.add_option("--height", options.height, "The height of the picture in pixels")->capture_default_str();
    app.allow_extras();
    app.footer(stateOptionsHelp());
}

void renderPicture(const CLI::App& app, const RenderOptions& options, parallel::ForkJoin& forkJoin) {
    const auto viewport = valueOrThrow(pipeline::checkViewport({options.width, options.height}, {}));
    const auto state = loadState(queryFromArguments(app.remaining()), session::kPictureParameters);
    pipeline::Pipeline pipeline(std::make_unique<raster::LocalRasterizer>(&forkJoin), &forkJoin,
                                {.sliceEdges = std::numeric_limits<std::size_t>::max()});
    std::vector<std::uint8_t> png;
    const scene::PictureRequest picture = session::pictureRequestOf(state, viewport);
    pipeline.drawPng(picture, wire::stateMessageOutsideSessions(state, pipeline.nameFocusSection(picture).names), png);
    writeOutput(options.output, {reinterpret_cast<const char*>(png.data()), png.size()});
}

}  // namespace oval4d
