#pragma once

#include "render/overlay/overlay.hpp"
#include "scene/scene.hpp"

namespace oval4d::render {

/// Adds the matrix of planar sections to `overlay`, and the lines that show the focus point in the focus slice (the
/// middle one). Does nothing if the scene shows no matrix. The edges of a section have the colors of the cells from
/// which they were cut. The contours of a field have the colors of their levels. The lines through the focus point in a
/// panel show where the plane of this panel meets the planes of the other panels in the same row and column.
void addMatrixAndFocusLines(const scene::Scene& scene, Overlay& overlay);

}  // namespace oval4d::render
