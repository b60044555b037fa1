#pragma once

#include "export/drawing/drawing.hpp"
#include "scene/scene.hpp"

namespace oval4d::exports {

/// Draws the projection of the whole object to three dimensions, and the sections in it. The drawing is a parallel
/// projection along the direction in which the camera looks. Sorts the shapes by depth; nearer bars are darker. The
/// scene must show the projection.
Drawing drawProjection(const scene::Scene& scene);

}  // namespace oval4d::exports
