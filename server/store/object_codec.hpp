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

/// Returns the record of an object. If the samples of a field are too large for memory, the record contains the name of
/// its file in the server's data folder instead of the samples.
std::string encodeObjectRecord(const slicing::Object& object);

/// Returns whether a record contains the name of a file instead of samples.
bool refersToFile(std::string_view record);

/// A function that reads a field from the server's data folder. Blocks the calling thread.
using DataFolderReader = std::function<Result<slicing::Object>(const session::LoadObject& load)>;

/// Returns the object in a record that encodeObjectRecord() has made. Validates the object like one from a client's
/// file. `open` reads files in the data folder; if it is empty, no file can be read. Throws UnreadableRecord if the
/// record is invalid, or if it names a file that cannot be read.
slicing::Object decodeObjectRecord(std::string_view bytes, const DataFolderReader& open = {});

}  // namespace oval4d::store
