#pragma once
// Functions that read values from the JSON files of Zarr folders, which contain the metadata.

#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "errors/error.hpp"

namespace oval4d::fields {

/// Returns the error `bad_field` for metadata that are not valid, with the reason.
Error badMetadataError(std::string reason);

/// Returns a value in quotes, for error messages. Returns a string in full, and the first 60 characters of the JSON
/// text of any other value.
std::string quoted(const nlohmann::json& value);

/// Returns the text of a JSON file, with NaN and Infinity, which Python writes into such files, replaced by null.
std::string replaceNanByNull(std::string text);

/// Returns a member of an object. Returns nullptr if `object` is not a JSON object, or if the member does not exist or
/// is null.
const nlohmann::json* findMember(const nlohmann::json& object, std::string_view name);

/// Returns a member that is a string. Returns an empty string if there is no such member, or if it is not a string.
std::string stringMember(const nlohmann::json& object, std::string_view name);

/// Returns the number that a value stands for: a number itself; 1 or 0 for true or false; NaN or an infinity for the
/// strings "NaN", "Infinity" and "-Infinity". Returns an empty optional for other values.
std::optional<double> numberIn(const nlohmann::json& value);

/// Returns the number that a text encodes as a little-endian double in Base64 (RFC 4648). In version 3 of Zarr, xarray
/// writes the attribute _FillValue of floats in this form. Returns an empty optional for any other text.
std::optional<double> base64DoubleIn(const std::string& text);

}  // namespace oval4d::fields
