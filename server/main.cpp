// Reads the options, and does what they say.

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <iostream>

#include "export_command.hpp"
#include "net/options.hpp"
#include "net/server.hpp"
#include "picture/drawing_process.hpp"
#include "render_command.hpp"

namespace {

void startLog(const std::string& level) {
    spdlog::set_default_logger(spdlog::stderr_color_mt("oval4d"));
    spdlog::set_pattern("%Y-%m-%dT%H:%M:%S.%e %^%l%$ %v");
    spdlog::set_level(spdlog::level::from_str(level));
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{
        "oval4d shows four-dimensional polytopes by an oval of parallel slices.\n"
        "Without a subcommand it serves; every option of the service is an environment variable too."};
    app.set_version_flag("--version", "oval4d " OVAL4D_VERSION);
    oval4d::net::Options options;
    options.webRoot = OVAL4D_WEB_ROOT;
    oval4d::net::addOptions(app, options);
    app.add_subcommand("serve", "Serve the page, the API and the sessions (the default)")->fallthrough();
    oval4d::RenderOptions renderOptions;
    CLI::App* render = app.add_subcommand("render", "Write one picture as a PNG file");
    oval4d::addRenderOptions(*render, renderOptions);
    oval4d::ExportOptions exportOptions;
    CLI::App* exporting = app.add_subcommand("export", "Write a slice or the oval as a file for other programs");
    oval4d::addExportOptions(*exporting, exportOptions);
    const CLI::App* draw = app.add_subcommand(oval4d::picture::kDrawingCommand)->group("");  // the server's own
    app.require_subcommand(0, 1);
    CLI11_PARSE(app, argc, argv);

    startLog(options.logLevel);
    try {
        if (*draw) {
            oval4d::picture::serveDrawing(oval4d::picture::kDrawingSocket);
        } else if (*render) {
            oval4d::renderPicture(*render, renderOptions);
        } else if (*exporting) {
            oval4d::exportFile(*exporting, exportOptions);
        } else {
            oval4d::net::runServer(options);
        }
    } catch (const std::exception& fault) {
        std::cerr << "oval4d: " << fault.what() << "\n";
        return 1;
    }
    return 0;
}
