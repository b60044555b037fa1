#pragma once

#include "export/drawing/drawing.hpp"
#include "scene/scene.hpp"

namespace oval4d::exports {

/// Draws the projection of the whole object to three dimensions, with the sections that it contains. From three to two
/// dimensions, the drawing is a parallel projection along the direction in which the camera looks. Nearer shapes cover
/// farther ones, and nearer bars are darker. The scene must show the projection.
Drawing drawProjection(const scene::Scene& scene);

}  // namespace oval4d::exports
