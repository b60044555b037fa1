#pragma once

#include <glm/vec4.hpp>

#include "export/drawing/drawing.hpp"
#include "scene/scene.hpp"

namespace oval4d::exports {

/// Draws the matrix of planar sections (sections by planes parallel to two axes). The panels are arranged as in
/// scene::SectionMatrixLayout. Edges have the colors of their cells, and contours of a field have the colors of their
/// levels. `origin`, which is ObjectInfo::originInFile, is added to coordinates, so that the numbers at the axes are
/// coordinates in the object's file. The scene must show the matrix.
Drawing drawMatrix(const scene::Scene& scene, const glm::dvec4& origin);

}  // namespace oval4d::exports
