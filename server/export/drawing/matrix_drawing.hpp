#pragma once

#include "export/drawing/drawing.hpp"
#include "scene/scene.hpp"

namespace oval4d::exports {

/// Draws the matrix of planar sections, whose panels are arranged as in scene::MatrixLayout. Edges have the colors of
/// their cells. The scene must show the matrix.
Drawing drawMatrix(const scene::Scene& scene);

}  // namespace oval4d::exports
