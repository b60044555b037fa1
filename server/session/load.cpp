#include "session/load.hpp"

#include <algorithm>
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

}  // namespace

Result<PolytopePtr> readPolytope(const protocol::Load& load, const Limits& limits) {
    if (load.name.empty() || load.name.size() > 4 * kMaxName ||
        std::any_of(load.name.begin(), load.name.end(), isControl)) {
        return Error{ErrorCode::bad_message, "a polytope's name must have 1 to 64 printable characters"};
    }
    if (std::holds_alternative<geometry::Design>(geometry::designNamed(load.name, limits.maxVertices))) {
        return Error{ErrorCode::bad_polytope,
                     protocol::inQuotes(load.name) + " is a name of the catalogue; choose another"};
    }
    if (load.format != "off") {
        return Error{ErrorCode::unsupported_format,
                     "the format " + protocol::inQuotes(load.format) + " cannot be read; allowed is off (4OFF)"};
    }
    auto imported = geometry::importOff4(load.data, load.name, limits.maxVertices);
    if (auto* error = std::get_if<geometry::ImportError>(&imported)) {
        const std::string where = error->line > 0 ? "line " + std::to_string(error->line) + ": " : "";
        return Error{error->tooLarge ? ErrorCode::too_large : ErrorCode::bad_polytope, where + error->reason};
    }
    return PolytopePtr(std::make_shared<const geometry::Polytope>(std::move(std::get<geometry::Polytope>(imported))));
}

}  // namespace oval4d::session
