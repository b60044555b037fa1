#pragma once
// Values in the JSON files of Zarr folders.

#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "errors/error.hpp"

namespace oval4d::fields {

/// Returns the error `bad_field` for metadata that are not valid.
Error badMetadata(std::string reason);

/// Returns a value in quotes, for error messages: a string in full, and of any other value the first 60 characters of
/// its JSON text.
std::string quoted(const nlohmann::json& value);

/// Returns the text of a file with NaN and Infinity, which Python writes into JSON files, replaced by null.
std::string withoutNan(std::string text);

/// Returns a member of an object; null if there is none, if it is null, or if `object` is no object.
const nlohmann::json* member(const nlohmann::json& object, std::string_view name);

/// Returns a member that is a string; an empty string if there is none.
std::string textIn(const nlohmann::json& object, std::string_view name);

/// Returns a number, 1 or 0 for true or false, and NaN or an infinity for the strings "NaN", "Infinity" and
/// "-Infinity"; an empty optional for other values.
std::optional<double> numberIn(const nlohmann::json& value);

/// Returns the number that a text encodes: a little-endian double in Base64 (RFC 4648), as xarray writes the attribute
/// _FillValue of floats in version 3; an empty optional for any other text.
std::optional<double> base64DoubleIn(const std::string& text);

}  // namespace oval4d::fields
