#pragma once

#include <string>

#include "export/formats/format.hpp"

namespace oval4d::exports {

/// Returns a VTK XML file of the type PolyData, in the object's own units. For ExportContents::oval, the slices are
/// placed as in the picture. For a polytope, the file has the faces of the slices, with the array `cell`. For a field,
/// it has the surfaces of all levels, with the arrays `value`, `second_value` (if there is a second function),
/// `normals` and `growth` (see slicing::SliceSurface) for each point, and `level` and `cap` for each triangle. The
/// arrays `n` and `w` have, for each face or triangle, the index n and the w of the hyperplane of its slice. Infinite
/// growth is written as NaN. Adds a warning about slices without faces or triangles. Throws ExportRefused if a limit is
/// exceeded or a stop is requested.
std::string vtp(const SceneInput& source);

}  // namespace oval4d::exports
