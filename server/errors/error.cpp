#include "errors/error.hpp"

#include <array>

namespace oval4d {

namespace {
constexpr std::array<std::string_view, 22> kNames{
    "bad_json",       "bad_message",     "unknown_type",   "unknown_key",  "unknown_polytope", "unknown_command",
    "bad_expression", "out_of_range",    "not_a_rotation", "bad_polytope", "bad_field",        "unsupported_format",
    "no_body",        "nothing_to_undo", "hello_first",    "not_found",    "bad_token",        "too_many",
    "too_large",      "canceled",        "later_version",  "internal"};
static_assert(kNames.size() == static_cast<std::size_t>(ErrorCode::internal) + 1);
}  // namespace

std::string_view protocolName(ErrorCode code) { return kNames[static_cast<std::size_t>(code)]; }

}  // namespace oval4d
