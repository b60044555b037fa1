#pragma once
// Encodes objects of all kinds (polytopes, point clouds, fields and surfaces) as CBOR records, and decodes them. No
// other file in store/ distinguishes between kinds of objects.

#include <functional>
#include <string>
#include <string_view>

#include "errors/error.hpp"
#include "session/command.hpp"
#include "slicing/object.hpp"
#include "store/unreadable_record.hpp"

namespace oval4d::store {

/// Returns the record of an object. If a field has a fields::FieldFileSource (it is in a file of the server's data
/// folder, and not wholly in memory), the record contains the name of this file instead of the samples.
std::string encodeObjectRecord(const slicing::Object& object);

/// Returns whether the record of an object contains the name of a file instead of samples.
bool refersToFile(std::string_view record);

/// A function that reads a field from a file in the server's data folder. Blocks the calling thread.
using DataFolderReader = std::function<Result<slicing::Object>(const session::LoadObject& load)>;

/// Returns the object in a record that encodeObjectRecord() has made. Validates the object like one from a client's
/// file. `open` reads a field that the record only names; if `open` is empty, no such field can be read. Throws
/// UnreadableRecord if the record is invalid, or if it names a file that cannot be read. Throws NewerVersionRecord if a
/// later version of the program has stored it.
slicing::Object decodeObjectRecord(std::string_view bytes, const DataFolderReader& open = {});

}  // namespace oval4d::store
