#pragma once
// Encodes objects (polytopes, point clouds) as CBOR records and decodes them. No other file in store/ depends on the
// kind of an object.

#include <string>
#include <string_view>

#include "slicing/object.hpp"
#include "store/unreadable.hpp"

namespace oval4d::store {

/// Returns the record of an object.
std::string encodeObject(const slicing::Object& object);

/// Returns the object in a record made by encodeObject, and validates it like an object from a client's file. Throws
/// Unreadable if it is invalid.
slicing::Object decodeObject(std::string_view bytes);

}  // namespace oval4d::store
