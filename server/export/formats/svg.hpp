#pragma once

#include <string>

#include "export/formats/format.hpp"

namespace oval4d::exports {

/// Returns an SVG drawing of the parallel coordinates of the rotated vertices. If there are more than
/// scene::kMaxVerticesAsLines vertices, the drawing is a density plot.
std::string parallelCoordinatesSvg(const SceneInput& source);

}  // namespace oval4d::exports
