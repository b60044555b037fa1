#pragma once
// The message schemas of protocol/schema/, checked with valijson.

#include <optional>
#include <span>
#include <string_view>

#include <nlohmann/json.hpp>

#include "protocol/cpp/error.hpp"

namespace oval4d::protocol {

/// The types of the messages to the server.
std::span<const std::string_view> requestTypes();

/// Nothing if `message` fits the schema of this type; else what is wrong, where, and what is allowed, in one sentence:
/// "rotate: /angles/0 must be a finite number of radians". A number beyond its bounds is out_of_range, all else
/// bad_message. The type must have a schema.
std::optional<Error> misfit(std::string_view type, const nlohmann::json& message);

}  // namespace oval4d::protocol
