#pragma once

#include <string>

#include "export/formats/format.hpp"

namespace oval4d::exports {

/// Returns the rotated object, a polytope or a point cloud, as a 4OFF file in the object's own units. Importing the
/// file of a polytope gives the rotated polytope; the file of a point cloud has vertices only.
std::string off(const SceneInput& source);

}  // namespace oval4d::exports
