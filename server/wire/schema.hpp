#pragma once
// Validates messages against the JSON Schemas in protocol/schema/, with valijson.

#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "errors/error.hpp"

namespace oval4d::wire {

/// Validates `message` against the schema of the message type `type`; throws std::logic_error if there is no schema of
/// this type. Returns an empty optional if the message is valid, else an error whose text says what is wrong, where,
/// and what is allowed, such as "rotate: /angles/0 must be a finite number of radians". Errors: `out_of_range` for a
/// number outside its bounds, `bad_message` for all other faults.
std::optional<Error> validationError(std::string_view type, const nlohmann::json& message);

/// Reads the schema, or the part of one, that `reference` names: a file in protocol/schema/, which may be followed by
/// '#' and a JSON pointer (RFC 6901), as in "settings.schema.json#/properties/view". In the result, each "$ref" to
/// another file is replaced by the schema to which it refers, and the keywords beside the "$ref" are added to this
/// schema. If both have a keyword, the one beside the "$ref" is used, except that `properties`, `items` and `required`
/// are combined. Throws nlohmann::json::exception if there is no such file or part.
nlohmann::json readSchema(const std::string& reference);

}  // namespace oval4d::wire
