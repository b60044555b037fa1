#include "cli/export_command.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <limits>

#include "cli/state_arguments.hpp"
#include "pipeline/export_pipeline.hpp"
#include "text/message_text.hpp"

namespace oval4d {

namespace {

const exports::Format& formatOf(const ExportOutputOptions& options) {
    std::string name = options.format;
    if (name.empty()) name = std::filesystem::path(options.output).extension().string();
    if (name.starts_with('.')) name.erase(0, 1);
    if (const exports::Format* format = exports::formatNamed(name)) return *format;
    const std::string known = text::commaSeparated(exports::formatNames());
    throw std::runtime_error(name.empty()
                                 ? "give a --format, one of " + known
                                 : "no format is called " + text::inQuotes(name) + "; the formats are " + known);
}

/// Limits far above those of the server, because the user decides how much time and memory to spend on this machine.
exports::ExportLimits commandLineLimits() {
    exports::ExportLimits limits;
    limits.triangles = 50'000'000;
    limits.bytes = std::numeric_limits<std::size_t>::max();
    limits.time = std::chrono::hours(1);
    return limits;
}

}  // namespace

void addExportOptions(CLI::App& app, ExportOutputOptions& options) {
    app.add_option("-o,--output", options.output, "The file to write, - for standard output")->capture_default_str();
    app.add_option("--format", options.format,
                   text::commaSeparated(exports::formatNames()) + "; default: from the output's extension");
    app.allow_extras();
    app.footer(
        std::string(
            "The content of the file:\n"
            "  --of focus|oval|coordinates|projection|matrix  --body solid|skeleton  --size MILLIMETERS  --label "
            "none|engraved|separate\n") +
        kStateHelp);
}

void exportFile(const CLI::App& app, const ExportOutputOptions& options) {
    session::QueryParameters query = queryOf(app.remaining());
    const auto request = valueOrThrow(pipeline::extractExportRequest(query, formatOf(options)));
    const auto state = stateOf(query);
    writeOutput(options.output, valueOrThrow(pipeline::exportState(state, request, commandLineLimits())));
}

}  // namespace oval4d
