#pragma once
// Draws the annotations of a picture: axes, labels and parallel coordinates. The functions add shapes and boxes to
// lists; the caller draws the lists.

#include "render/overlay/overlay.hpp"
#include "render/slices/shape_batch.hpp"
#include "scene/scene.hpp"

namespace oval4d::render {

/// Draws the x, y and z axes, with their names, as the camera sees them, at the place that Scene::axes specifies.
void paintAxes(const scene::Scene& scene, ShapeBatch& shapes, Overlay& overlay);

/// Draws the labels of the slices, which show the values of w. The label of the focus slice is highlighted, and is
/// drawn after the others.
void paintLabels(const scene::Scene& scene, Overlay& overlay);

/// Draws the parallel coordinates of the rotated vertices along the bottom. If a density strip or the histogram of a
/// field is shown instead, draws only its axes and marks; DensityStrip draws the rest. Does nothing if none of these is
/// shown.
void paintCoordinates(const scene::Scene& scene, Overlay& overlay);

}  // namespace oval4d::render
