#pragma once
// Serializes 4-D objects, for messages between processes of this program and for stored sessions.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "fields/array/mapped_file.hpp"
#include "fields/array/shape.hpp"
#include "serialization/byte_archive.hpp"
#include "slicing/object.hpp"

namespace oval4d::slicing {

/// The memory-mapped files that contain the samples of arrays. A message refers to a file by its index in this list.
/// The message does not contain the files: their file descriptors are sent separately.
using MappedFiles = std::vector<fields::MappedFilePtr>;

/// Encodes an object, with its name and serial number, to the bytes `out`, in the byte order and number formats of this
/// machine. The object must not have been made by transformedTo(), because a field is encoded without its frame of
/// reference. Overwrites `out`. Sets `files` to the files that the receiver needs.
void encodeObject(const Object& object, std::string& out, MappedFiles& files);

/// Decodes an object from the bytes that encodeObject() wrote. `files` must have the files that encodeObject() listed.
/// The sender must be trusted, because not all bytes are validated. Throws std::runtime_error if bytes or files are
/// missing.
Object decodeObject(std::string_view bytes, const MappedFiles& files = {});

/// Writes the data from which readObjectContent() rebuilds the object: the members that are stored (see
/// serialization/stored_members.hpp). For a field, always writes its functions (formulas or samples) and its domain.
///
/// The samples of an array are written inline if they are not in a file, or if the total number of inline samples of
/// the object stays at most `maxInMemory`. Otherwise, a reference to the file of the samples is written, and the file
/// is added to `files` if it is not in the list yet.
void writeObjectContent(const Object& object, serialization::ByteWriter& archive, MappedFiles& files,
                        std::size_t maxInMemory = fields::kMaxSamples);

/// Builds an object from the data that writeObjectContent() wrote, with the name `name` and a new serial number. The
/// sender need not be trusted. Throws std::runtime_error with the reason if the object is invalid, if it has more than
/// `maxVertices` vertices or points, or if samples are neither inline nor in one of `files`.
Object readObjectContent(serialization::ByteReader& archive, const std::string& name, std::size_t maxVertices,
                         const MappedFiles& files = {});

}  // namespace oval4d::slicing
