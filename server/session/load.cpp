#include "session/load.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <variant>

#include "geometry/catalogue.hpp"
#include "geometry/import.hpp"
#include "protocol/cpp/suggest.hpp"

namespace oval4d::session {

namespace {

using protocol::Error;
using protocol::ErrorCode;
using protocol::Result;

constexpr std::size_t kMaxName = 64;

bool isControl(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }

struct NamedFormat {
    std::string_view name;
    geometry::FileFormat format;
};
constexpr auto kFormats =
    std::to_array<NamedFormat>({{"off", geometry::FileFormat::off4}, {"points", geometry::FileFormat::points}});

Result<Reading> read(geometry::FileFormat format, std::string_view text, const std::string& name,
                     const Limits& limits) {
    auto imported = geometry::importPolytope(format, text, name, {limits.maxVertices, limits.maxHullCells});
    if (auto* error = std::get_if<geometry::ImportError>(&imported)) {
        const std::string where = error->line > 0 ? "line " + std::to_string(error->line) + ": " : "";
        return Error{error->tooLarge ? ErrorCode::too_large : ErrorCode::bad_polytope, where + error->reason};
    }
    auto& [polytope, warnings] = std::get<geometry::Imported>(imported);
    return Reading{std::make_shared<const geometry::Polytope>(std::move(polytope)), std::move(warnings)};
}

}  // namespace

Result<Reading> readPolytope(const protocol::Load& load, const Limits& limits) {
    if (load.name.empty() || load.name.size() > 4 * kMaxName ||
        std::any_of(load.name.begin(), load.name.end(), isControl)) {
        return Error{ErrorCode::bad_message, "a polytope's name must have 1 to 64 printable characters"};
    }
    if (std::holds_alternative<geometry::Design>(geometry::designNamed(load.name, limits.maxVertices))) {
        return Error{ErrorCode::bad_polytope,
                     protocol::inQuotes(load.name) + " is a name of the catalogue; choose another"};
    }
    const auto format = std::find_if(kFormats.begin(), kFormats.end(),
                                     [&](const NamedFormat& known) { return known.name == load.format; });
    if (format == kFormats.end()) {
        return Error{ErrorCode::unsupported_format, "the format " + protocol::inQuotes(load.format) +
                                                        " cannot be read; allowed are off (4OFF) and points"};
    }
    return read(format->format, load.data, load.name, limits);
}

Result<Reading> readPolytope(const std::string& text, const std::string& name, const Limits& limits) {
    return read(geometry::formatOf(text), text, name, limits);
}

}  // namespace oval4d::session
