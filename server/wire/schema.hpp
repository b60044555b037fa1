#pragma once
// Validates messages against the JSON schemas in protocol/schema/ with the library valijson.

#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "errors/error.hpp"

namespace oval4d::wire {

/// Validates `message` against the schema of the message type `type`. Returns an empty optional if the message is
/// valid. The text of an error says what is wrong, where, and what is allowed, such as "rotate: /angles/0 must be a
/// finite number of radians". Errors: `out_of_range` for a number outside its bounds; `bad_message` for all other
/// faults. Throws std::logic_error if there is no schema of this type.
std::optional<Error> validationError(std::string_view type, const nlohmann::json& message);

/// Reads a schema or a part of a schema. `reference` is the name of a file in protocol/schema/, optionally followed by
/// '#' and a JSON pointer (RFC 6901), as in "settings.schema.json#/properties/view".
/// Replaces each "$ref" to another file by the schema in that file, and adds the keywords beside the "$ref" to this
/// schema. If both have the same keyword, the one beside the "$ref" wins; but `properties`, `items` and `required` are
/// combined. Throws nlohmann::json::exception if there is no such file or part.
nlohmann::json readSchema(const std::string& reference);

}  // namespace oval4d::wire
