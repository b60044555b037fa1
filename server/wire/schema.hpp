#pragma once
// Validates messages against the JSON Schemas in protocol/schema/, with valijson.

#include <optional>
#include <span>
#include <string_view>

#include <nlohmann/json.hpp>

#include "errors/error.hpp"

namespace oval4d::wire {

/// The types of all messages to the server.
std::span<const std::string_view> requestTypes();

/// Validates `message` against the schema of this type, which must exist. Returns nothing if it is valid, otherwise an
/// error whose message says what is wrong, where, and what is allowed: "rotate: /angles/0 must be a finite number of
/// radians". Errors: `out_of_range` for a number outside its bounds, `bad_message` for anything else.
std::optional<Error> validationError(std::string_view type, const nlohmann::json& message);

}  // namespace oval4d::wire
