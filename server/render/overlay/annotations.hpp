#pragma once
// Draws the annotations of the picture: axes, labels and parallel coordinates.

#include "render/overlay/overlay.hpp"
#include "render/slices/shape_batch.hpp"
#include "scene/scene.hpp"

namespace oval4d::render {

/// Draws the labeled x, y and z axes in the upper left corner, as the camera sees them.
void paintAxes(const scene::Scene& scene, ShapeBatch& shapes, Overlay& overlay);

/// Draws the label of each slice, which shows its w, in the order of the slices. The focus slice's label is drawn last
/// and highlighted.
void paintLabels(const scene::Scene& scene, Overlay& overlay);

/// Draws the parallel coordinates of the rotated vertices along the bottom. If a density strip is shown instead of
/// lines, draws only the strip's axes; DensityStrip draws the strip.
void paintCoordinates(const scene::Scene& scene, Overlay& overlay);

}  // namespace oval4d::render
