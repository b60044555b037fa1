#pragma once

#include <string>

#include "export/formats/format.hpp"

namespace oval4d::exports {

/// Returns a binary little-endian PLY file in millimeters, with all bodies in one mesh and a color for each triangle.
/// For fields, not the triangles but the points have colors, and each point has the value of the function as the
/// property `value`; the value is NaN at the points of labels.
std::string ply(const MeshesToWrite& meshes);

}  // namespace oval4d::exports
