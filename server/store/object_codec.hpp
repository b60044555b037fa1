#pragma once
// Encodes objects (polytopes, point clouds) as CBOR records and decodes them. No other file in store/ distinguishes
// between kinds of objects.

#include <string>
#include <string_view>

#include "slicing/object.hpp"
#include "store/unreadable_record.hpp"

namespace oval4d::store {

/// Returns the record of an object.
std::string encodeObjectRecord(const slicing::Object& object);

/// Returns the object in a record made by encodeObjectRecord, and validates it like an object from a client's file.
/// Throws UnreadableRecord if it is invalid.
slicing::Object decodeObjectRecord(std::string_view bytes);

}  // namespace oval4d::store
