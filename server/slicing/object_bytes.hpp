#pragma once
// Serializes objects, for messages between processes of this program.

#include <cstddef>
#include <string>
#include <string_view>

#include "serialization/byte_archive.hpp"
#include "slicing/object.hpp"

namespace oval4d::slicing {

/// Encodes an object with all its data, including its serial number, in the byte order and number formats of this
/// machine. Overwrites `out`.
void encodeObject(const Object& object, std::string& out);

/// Decodes the bytes of `encodeObject`. The sender must be trusted: the bytes are not validated. Throws
/// std::runtime_error if bytes are missing.
Object decodeObject(std::string_view bytes);

/// Writes the data from which `readParts` rebuilds the object: the vertices, 2-faces, cells and cell types of a
/// polytope, or the points and radii of a cloud; not the name.
void writeParts(const Object& object, serialization::ByteWriter& archive);

/// Builds an object with this name and a new serial number from the data of `writeParts`. The sender need not be
/// trusted: throws std::runtime_error with the reason if the object is invalid or has more than `maxVertices` vertices
/// or points.
Object readParts(serialization::ByteReader& archive, const std::string& name, std::size_t maxVertices);

}  // namespace oval4d::slicing
