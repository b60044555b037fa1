#pragma once
// Encodes sessions as CBOR records, and decodes them.

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "polytopes/catalogue/polytope_cache.hpp"
#include "session/session.hpp"
#include "store/unreadable_record.hpp"

namespace oval4d::store {

/// A function that returns the key under which an object is stored. It is called only for objects that cannot be built
/// from their names. Its results must differ for different objects of a session.
using ObjectKeyLookup = std::function<std::string(const slicing::Object&)>;
/// A function that returns the stored object with this key, or an empty optional if there is none. May throw
/// UnreadableRecord.
using ObjectLookup = std::function<std::optional<slicing::Object>(const std::string&)>;

/// Encodes the head of a session: the current state and the revision, which almost every command changes. The head is
/// small: a few hundred bytes.
std::string encodeHead(const session::Session& session, const ObjectKeyLookup& keyOf);

/// Encodes the whole session, but at most its last `maxUndo` undo steps and its last `maxUndo` redo steps.
std::string encodeWhole(const session::Session& session, std::size_t maxUndo, const ObjectKeyLookup& keyOf);

/// Decodes a session from the results of encodeWhole() and encodeHead(). If `head` has a later revision than `whole`,
/// the state in `head` becomes the current state, the state in `whole` becomes the latest undo step, and the redo steps
/// are dropped. Otherwise, `head` is ignored; it may be empty. Objects that can be built from their names come from
/// `cache`, all others from `objectOf`. Throws UnreadableRecord if a record is invalid or an object is missing, and
/// NewerVersionRecord if a later version of the program has stored a record.
session::Session decodeSession(std::string_view whole, std::string_view head, const ObjectLookup& objectOf,
                               polytopes::PolytopeCache& cache);

}  // namespace oval4d::store
