#pragma once
// Sessions as CBOR records.

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "polytopes/catalogue/polytope_cache.hpp"
#include "session/session.hpp"
#include "store/unreadable.hpp"

namespace oval4d::store {

/// Returns the key of an object that is not built from its name. Keys are unique within one session's record.
using ObjectKeyLookup = std::function<std::string(const slicing::Object&)>;
/// Returns the object with this key, if there is one. May throw Unreadable.
using ObjectLookup = std::function<std::optional<slicing::Object>(const std::string&)>;

/// Encodes what every command changes, the current state and its revision: a few hundred bytes.
std::string encodeHead(const session::Session& session, const ObjectKeyLookup& keyOf);

/// Encodes the whole session, with at most `maxUndo` undo steps and as many redo steps.
std::string encodeWhole(const session::Session& session, std::size_t maxUndo, const ObjectKeyLookup& keyOf);

/// Decodes `whole`. If `head` has a later revision, its state becomes the current one, one undo step after that of
/// `whole`. An empty `head` is ignored. Objects that are built from their names come from `cache`. Throws Unreadable.
session::Session decode(std::string_view whole, std::string_view head, const ObjectLookup& objectOf,
                        polytopes::PolytopeCache& cache);

}  // namespace oval4d::store
