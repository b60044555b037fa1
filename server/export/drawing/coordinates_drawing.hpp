#pragma once

#include "export/drawing/drawing.hpp"
#include "scene/scene.hpp"

namespace oval4d::exports {

/// Draws the parallel coordinates of all rotated vertices; if there are more than scene::kMaxVerticesAsLines, as a
/// density strip.
Drawing drawCoordinates(const scene::Scene& scene);

}  // namespace oval4d::exports
