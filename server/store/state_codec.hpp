#pragma once
// Encodes states of a session as CBOR arrays, and decodes them.

#include <nlohmann/json.hpp>

#include "session/session.hpp"
#include "store/object_list.hpp"

namespace oval4d::store {

/// Encodes a state as an array. Adds the state's source object to `objects`, and encodes its index there.
nlohmann::json encodeState(const session::State& state, ObjectListEncoder& objects);

/// Decodes a state from an array. Members that a record of an earlier version lacks get their defaults. Throws
/// UnreadableRecord if a member is invalid or does not fit another member. Throws NewerVersionRecord if a member is
/// unknown, exceeds a limit, or refers to an element or a cell type that the object lacks.
session::State decodeState(const nlohmann::json& array, ObjectListDecoder& objects);

}  // namespace oval4d::store
