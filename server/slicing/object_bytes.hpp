#pragma once
// Objects as bytes, for messages between this program's own processes.

#include <cstddef>
#include <string>
#include <string_view>

#include "serialization/byte_archive.hpp"
#include "slicing/object.hpp"

namespace oval4d::slicing {

/// Encodes the whole object with its serial number, in its memory layout. Overwrites `out`.
void encodeObject(const Object& object, std::string& out);

/// Decodes an object from a trusted sender: does not validate it. Throws std::runtime_error if bytes are missing.
Object decodeObject(std::string_view bytes);

/// Writes the data from which `readParts` rebuilds the object: vertices, 2-faces, cells and cell types, but no name.
void writeParts(const Object& object, serialization::ByteWriter& archive);

/// Builds an object with this name, and a serial number of this process, from the data of `writeParts`. Validates
/// everything: throws std::runtime_error with the reason if there are more than `maxVertices` vertices or the object is
/// invalid.
Object readParts(serialization::ByteReader& archive, const std::string& name, std::size_t maxVertices);

}  // namespace oval4d::slicing
