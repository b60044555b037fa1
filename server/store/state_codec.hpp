#pragma once
// Encodes states as CBOR arrays and decodes them.

#include <nlohmann/json.hpp>

#include "session/session.hpp"
#include "store/object_list.hpp"

namespace oval4d::store {

/// Encodes a state as an array, and adds its object to `objects`.
nlohmann::json encodeState(const session::State& state, ObjectListWriter& objects);

/// Decodes a state. Members that the record lacks, because an earlier version has written it, get their defaults.
/// Throws UnreadableRecord if a member is invalid, or contradicts another one or the object.
session::State decodeState(const nlohmann::json& array, ObjectListReader& objects);

}  // namespace oval4d::store
