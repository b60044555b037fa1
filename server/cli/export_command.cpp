#include "cli/export_command.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <limits>

#include "cli/state_arguments.hpp"
#include "pipeline/export_pipeline.hpp"
#include "session/picture.hpp"
#include "text/choice.hpp"
#include "text/message_text.hpp"
#include "wire/export_query.hpp"

namespace oval4d {

namespace {

const exports::Format& outputFormatOf(const ExportOutputOptions& options) {
    std::string name = options.format;
    if (name.empty()) name = std::filesystem::path(options.output).extension().string();
    if (name.starts_with('.')) name.erase(0, 1);
    if (const exports::Format* format = exports::formatNamed(name)) return *format;
    const std::string known = text::commaSeparated(exports::formatNames());
    throw std::runtime_error(name.empty()
                                 ? "give a --format, one of " + known
                                 : "no format is called " + text::inQuotes(name) + "; the formats are " + known);
}

/// Returns the names in a table of choices, separated by "|", such as "solid|skeleton". If several names have the same
/// value, returns only the name that text::nameOf() returns for this value.
template <typename Choices>
std::string choiceNamesJoinedByBars(const Choices& choices) {
    std::string out;
    for (const auto& [name, value] : choices) {
        if (name != text::nameOf(choices, value)) continue;
        if (!out.empty()) out += '|';
        out += name;
    }
    return out;
}

/// Returns the limits of an export from the command line. The limits on triangles, bytes and time are far above those
/// of the server, because here the user decides how much time and memory to spend. The limit on slices is the server's
/// default.
exports::ExportLimits commandLineExportLimits() {
    exports::ExportLimits limits;
    limits.triangles = 50'000'000;
    limits.bytes = std::numeric_limits<std::size_t>::max();
    limits.time = std::chrono::hours(1);
    limits.slices = session::Limits{}.maxSlices;
    return limits;
}

}  // namespace

void addExportOptions(CLI::App& app, ExportOutputOptions& options) {
    app.add_option("-o,--output", options.output, "The file to write, - for standard output")->capture_default_str();
    app.add_option("--format", options.format,
                   text::commaSeparated(exports::formatNames()) + "; default: from the output's extension");
    app.allow_extras();
    app.footer("The contents of the file, as far as its format can contain them:\n  --of " +
               choiceNamesJoinedByBars(exports::kExportContents) + "\n  --body " +
               choiceNamesJoinedByBars(exports::kBodies) + "  --size MILLIMETERS  --label " +
               choiceNamesJoinedByBars(exports::kLabels) +
               "\n  --at W,W,… (slices at these w)  --fit N (N slices that all meet the object)"
               "\n  --exact on|off (on: the surfaces of a field are cut from its samples exactly)\n" +
               stateOptionsHelp());
}

void exportFile(const CLI::App& app, const ExportOutputOptions& options) {
    session::QueryParameters query = queryFromArguments(app.remaining());
    const auto request =
        valueOrThrow(wire::extractExportRequest(query, outputFormatOf(options), commandLineExportLimits().slices));
    const auto state = loadState(query, session::kFileParameters);
    const auto file =
        valueOrThrow(pipeline::exportFile(session::pictureRequestOf(state), request, commandLineExportLimits()));
    for (const std::string& warning : file.warnings) std::cerr << "oval4d: " << warning << '\n';
    writeOutput(options.output, file.bytes);
}

}  // namespace oval4d
