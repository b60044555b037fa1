#pragma once
// Objects as CBOR records: the one place in store/ that depends on the kind of an object.

#include <string>
#include <string_view>

#include "slicing/object.hpp"
#include "store/unreadable.hpp"

namespace oval4d::store {

std::string encodeObject(const slicing::Object& object);

/// Validates the object like one from a client's file. Throws Unreadable.
slicing::Object decodeObject(std::string_view bytes);

}  // namespace oval4d::store
