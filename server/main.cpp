// The main program: parses the command line, and runs the server or a subcommand.

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <iostream>

#include "cli/export_command.hpp"
#include "cli/render_command.hpp"
#include "file_reading/file_reader_service.hpp"
#include "net/confinement.hpp"
#include "net/server.hpp"
#include "net/server_options.hpp"
#include "parallel/fork_join.hpp"
#include "process/child_process.hpp"
#include "process/process_heap.hpp"
#include "process/sandbox.hpp"
#include "raster/rasterizer_service.hpp"

namespace {

void startLog(const std::string& level) {
    spdlog::set_default_logger(spdlog::stderr_color_mt("oval4d"));
    spdlog::set_pattern("%Y-%m-%dT%H:%M:%S.%e %^%l%$ %v");
    spdlog::set_level(spdlog::level::from_str(level));
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{
        "oval4d shows four-dimensional polytopes as an oval of parallel slices.\n"
        "Without a subcommand it runs the server; each option of the server can also be set by an environment "
        "variable."};
    app.set_version_flag("--version", "oval4d " OVAL4D_VERSION);
    oval4d::net::ServerOptions options;
    options.webRoot = OVAL4D_WEB_ROOT;
    oval4d::net::addOptions(app, options);
    app.add_subcommand("serve", "Run the server of the page, the API and the sessions (the default)")->fallthrough();
    oval4d::RenderOptions renderOptions;
    CLI::App* render = app.add_subcommand("render", "Write one picture as a PNG file");
    oval4d::addRenderOptions(*render, renderOptions);
    oval4d::ExportOutputOptions exportOptions;
    CLI::App* exporting = app.add_subcommand("export", "Write a slice or the oval as a file for other programs");
    oval4d::addExportOptions(*exporting, exportOptions);
    // The server starts this program again as child processes, with the next two subcommands, which --help does not
    // show. The child processes read their options from environment variables.
    const CLI::App* draw = app.add_subcommand(oval4d::raster::kRasterizerCommand)->group("");
    const CLI::App* read = app.add_subcommand(oval4d::file_reading::kFileReaderCommand)->group("");
    app.require_subcommand(0, 1);
    CLI11_PARSE(app, argc, argv);

    startLog(options.logLevel);
    oval4d::process::ProcessHeap heap;
    oval4d::parallel::ForkJoin forkJoin;
    try {
        if (!oval4d::process::forbidNewPrivileges()) spdlog::warn("the system does not support no_new_privs");
        if (*draw) {
            oval4d::raster::serveRasterizer(oval4d::process::kChildSocket, oval4d::net::rasterizerConfinement(options),
                                            forkJoin, heap);
        } else if (*read) {
            oval4d::file_reading::runFileReader(oval4d::process::kChildSocket,
                                                oval4d::net::fileReaderConfinement(options));
        } else if (*render) {
            oval4d::renderPicture(*render, renderOptions, forkJoin);
        } else if (*exporting) {
            oval4d::exportFile(*exporting, exportOptions);
        } else {
            oval4d::net::runServer(options, forkJoin, heap);
        }
    } catch (const std::exception& fault) {
        std::cerr << "oval4d: " << fault.what() << "\n";
        return 1;
    }
    return 0;
}
