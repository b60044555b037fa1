#include "export_command.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <limits>

#include "one_shot.hpp"
#include "picture/file.hpp"
#include "protocol/cpp/suggest.hpp"

namespace oval4d {

namespace {

exports::Format formatOf(const ExportOptions& options) {
    std::string name = options.format;
    if (name.empty()) name = std::filesystem::path(options.output).extension().string();
    if (name.starts_with('.')) name.erase(0, 1);
    if (const auto format = exports::named(exports::kFormats, name)) return *format;
    std::vector<std::string_view> known;
    for (const auto& format : exports::kFormats) known.push_back(format.name);
    throw std::runtime_error(name.empty() ? "give a --format, one of " + protocol::listed(known)
                                          : "no format is called " + protocol::inQuotes(name) + "; there are " +
                                                protocol::listed(known));
}

/// Whoever starts the command decides how long to wait, and has the memory.
exports::Limits withoutHurry() {
    exports::Limits limits;
    limits.triangles = 50'000'000;
    limits.bytes = std::numeric_limits<std::size_t>::max();
    limits.time = std::chrono::hours(1);
    return limits;
}

}  // namespace

void addExportOptions(CLI::App& app, ExportOptions& options) {
    app.add_option("-o,--output", options.output, "The file to write, - for standard output")->capture_default_str();
    app.add_option("--format", options.format,
                   "stl, 3mf, obj, ply, glb, off, csv or svg; without it, by the output's extension");
    app.allow_extras();
    app.footer(std::string("What the file holds:\n"
                           "  --of focus|oval  --body solid|frame  --size MILLIMETRES  --label "
                           "none|engraved|separate\n") +
               kStateHelp);
}

void exportFile(const CLI::App& app, const ExportOptions& options) {
    session::Query query = queryOf(app.remaining());
    const auto wish = valueOf(picture::takeWish(query, formatOf(options)));
    const auto state = stateOf(query);
    writeOutput(options.output, valueOf(picture::fileOf(state, wish, withoutHurry())));
}

}  // namespace oval4d
