#pragma once
// Annotations of the picture: axes, labels and parallel coordinates.

#include "render/overlay/overlay.hpp"
#include "render/slices/shape_batch.hpp"
#include "scene/scene.hpp"

namespace oval4d::render {

/// Draws the labeled x, y and z axes in the upper left corner, as oriented by the camera.
void paintAxes(const scene::Scene& scene, ShapeBatch& shapes, Overlay& overlay);

/// Draws the value of w under each slice, from far to near, and that of the focus last and highlighted.
void paintLabels(const scene::Scene& scene, Overlay& overlay);

/// Draws the parallel coordinates of the rotated vertices along the bottom; if there are very many vertices, only the
/// axes of the density strip.
void paintCoordinates(const scene::Scene& scene, Overlay& overlay);

}  // namespace oval4d::render
