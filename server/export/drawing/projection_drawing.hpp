#pragma once

#include "export/drawing/drawing.hpp"
#include "scene/scene.hpp"

namespace oval4d::exports {

/// Draws the projection of the whole object to three dimensions, with the sections that it contains. Maps the three
/// dimensions to paper by a parallel projection along the camera's direction of view. Nearer shapes cover farther
/// shapes. Nearer bars and balls of the object are darker. The scene must show the projection.
Drawing drawProjection(const scene::Scene& scene);

}  // namespace oval4d::exports
