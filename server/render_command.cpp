#include "render_command.hpp"

#include <CLI/CLI.hpp>
#include <fstream>
#include <iostream>
#include <stdexcept>

#include "picture/frame_limits.hpp"
#include "picture/painter.hpp"
#include "protocol/cpp/codec.hpp"

namespace oval4d {

namespace {

/// "--name value" and "--name=value" as a query, in the order in which they were typed.
session::Query queryOf(const std::vector<std::string>& words) {
    session::Query query;
    for (auto word = words.begin(); word != words.end(); ++word) {
        if (!word->starts_with("--"))
            throw std::runtime_error("'" + *word + "' is not an option; options begin with --");
        const std::size_t equals = word->find('=');
        const std::string name = word->substr(2, equals == std::string::npos ? equals : equals - 2);
        if (equals != std::string::npos) {
            query.emplace_back(name, word->substr(equals + 1));
        } else if (++word != words.end()) {
            query.emplace_back(name, *word);
        } else {
            throw std::runtime_error("--" + name + " needs a value");
        }
    }
    return query;
}

template <typename T>
T valueOf(protocol::Result<T> result) {
    if (!result) throw std::runtime_error(result.error().message);
    return std::move(*result);
}

void write(const std::string& path, const std::vector<std::uint8_t>& png) {
    std::ofstream file;
    if (path != "-") file.open(path, std::ios::binary);
    std::ostream& out = path == "-" ? std::cout : file;
    out.write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
    out.flush();
    if (!out) throw std::runtime_error("cannot write to " + path);
}

}  // namespace

void addRenderOptions(CLI::App& app, RenderOptions& options) {
    app.add_option("-o,--output", options.output, "The file to write, - for standard output")->capture_default_str();
    app.add_option("--width", options.width, "Pixels")->capture_default_str();
    app.add_option("--height", options.height, "Pixels")->capture_default_str();
    app.allow_extras();
    app.footer(
        "Any other option describes the state, as :set and the query of frame.png do:\n"
        "  --polytope 24-cell --rotate xw,yz:pi/8,pi/sqrt(3)-pi/8 --slices 31 --view single\n"
        "--rotate may be repeated; the rotations are carried out in the order given.");
}

void renderPicture(const CLI::App& app, const RenderOptions& options) {
    const auto viewport = valueOf(picture::checked({options.width, options.height}, {}));
    const auto state = valueOf(session::stateFromQuery(queryOf(app.remaining()), session::Limits{}));
    picture::Painter painter;
    geometry::SliceSet slices;
    std::vector<std::uint8_t> png;
    painter.cut(state, slices);
    painter.frame(state, slices, protocol::stateMessage(state, 0), viewport, png);
    write(options.output, png);
}

}  // namespace oval4d
