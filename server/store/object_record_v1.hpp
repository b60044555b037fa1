#pragma once
// Conversion of object records that earlier versions of this program have stored.

#include <nlohmann/json.hpp>

namespace oval4d::store {

/// Converts an object record from version 1 to version 2 (see object_codec.cpp). Moves large parts instead of copying
/// them. Throws UnreadableRecord, or an exception of the JSON library, if `record` does not have the form of version 1.
/// Does not check values.
nlohmann::json convertedFromVersion1(nlohmann::json record);

}  // namespace oval4d::store
