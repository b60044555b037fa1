#pragma once

#include <string>

#include "export/formats/format.hpp"

namespace oval4d::exports {

/// Returns the rotated object as a 4OFF file, in the object's own units. Reading the file of a polytope gives the same
/// polytope; the file of a point cloud lists its points.
std::string off(const SceneInput& source);

}  // namespace oval4d::exports
