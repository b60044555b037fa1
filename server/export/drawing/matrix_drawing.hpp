#pragma once

#include <glm/vec4.hpp>

#include "export/drawing/drawing.hpp"
#include "scene/scene.hpp"

namespace oval4d::exports {

/// Draws the matrix of planar sections, whose panels are arranged as in scene::MatrixLayout. Edges have the colors of
/// their cells. The numbers at the axes are coordinates in the file of the object, whose `origin` is
/// ObjectInfo::originInFile. The scene must show the matrix.
Drawing drawMatrix(const scene::Scene& scene, const glm::dvec4& origin);

}  // namespace oval4d::exports
