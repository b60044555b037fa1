#pragma once
// Finds an object by its name, and finds the next or previous object in the list of objects.

#include <optional>
#include <string_view>

#include "session/object_loader.hpp"
#include "session/session.hpp"

namespace oval4d::session {

/// Returns the loaded object called `name`. If there is none, returns the example field or the polytope with this name
/// (see polytopes::designNamed()). Errors: `unknown_polytope`, with the most similar names or with the reason;
/// `too_large` if the polytope would have more than `limits.maxVertices` vertices; errors of `loader`.
Result<slicing::Object> findObject(std::string_view name, const LoadedObjects& loaded, const Limits& limits,
                                   ObjectLoader& loader);

/// Returns the loaded object called `name`. If there is none, returns the example field with this name; without such a
/// field, an empty optional.
std::optional<slicing::Object> findLoadedOrExample(std::string_view name, const LoadedObjects& loaded);

/// Returns the object before (`by` = −1) or after (`by` = 1) `object` in the cyclic list of catalogue entries, example
/// fields and loaded objects. If the list does not contain `object`, returns the last example field for −1, and the
/// first catalogue entry for 1. Errors: the errors of ObjectLoader::polytopeOf().
Result<slicing::Object> neighborInObjectList(const slicing::Object& object, int by, const LoadedObjects& loaded,
                                             ObjectLoader& loader);

}  // namespace oval4d::session
