#pragma once

#include <string>

#include "export/formats/format.hpp"

namespace oval4d::exports {

/// Returns a VTK XML file of the type ImageData: the values of a field in slice 0, on a regular lattice that fills the
/// bounding box of the domain's slice, in the object's own units. The values of points outside the domain are NaN. The
/// object must be a field, and the contents must be ExportContents::focus. Throws ExportRefused if the slice is empty,
/// if a limit is exceeded, or if a stop is requested.
std::string vti(const SceneInput& source);

}  // namespace oval4d::exports
