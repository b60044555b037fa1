#pragma once
// The records of objects that earlier versions of this program have stored.

#include <nlohmann/json.hpp>

namespace oval4d::store {

/// Converts the record of an object with the version 1 to the version 2 (see object_codec.cpp). Moves large parts of
/// the record, instead of copying them. Throws UnreadableRecord, or an exception of the JSON library, if there is no
/// such record; values are not checked.
nlohmann::json convertedFromVersion1(nlohmann::json record);

}  // namespace oval4d::store
