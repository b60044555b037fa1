#pragma once
// Finds an object by its name, and the next or previous object in the list of objects.

#include <optional>
#include <string_view>

#include "session/object_loader.hpp"
#include "session/session.hpp"

namespace oval4d::session {

/// Returns the loaded object with this name or, if there is none, the example field or the polytope of this name (see
/// polytopes::designNamed()). Errors: `unknown_polytope`, with the most similar names or with the reason; `too_large`
/// if the polytope would have more than `limits.maxVertices` vertices; those of `loader`.
Result<slicing::Object> findObject(std::string_view name, const LoadedObjects& loaded, const Limits& limits,
                                   ObjectLoader& loader);

/// Returns the loaded object with this name or, if there is none, the example field; an empty optional if there is
/// neither.
std::optional<slicing::Object> loadedOrExample(std::string_view name, const LoadedObjects& loaded);

/// Returns the object `by` places after `object` in the cyclic list of catalogue entries, example fields and loaded
/// objects; `by` is 1 or −1. For an object that is not in the list, returns the first catalogue entry if `by` is 1, and
/// the last example field if `by` is −1. Errors: those of ObjectLoader::polytopeOf().
Result<slicing::Object> neighborOf(const slicing::Object& object, int by, const LoadedObjects& loaded,
                                   ObjectLoader& loader);

}  // namespace oval4d::session
