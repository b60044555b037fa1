#pragma once
// The annotations of a picture: axes, labels and parallel coordinates. The functions add shapes, boxes and texts to
// lists; the caller draws the lists.

#include "render/overlay/overlay.hpp"
#include "render/slices/shape_batch.hpp"
#include "scene/scene.hpp"

namespace oval4d::render {

/// Adds the x, y and z axes, as the camera sees them, to `shapes`, and their names to `overlay`, at the place that
/// Scene::axes specifies.
void addAxes(const scene::Scene& scene, ShapeBatch& shapes, Overlay& overlay);

/// Adds the labels of the slices, which show the values of w. The label of the focus slice is highlighted, and is added
/// after the others.
void addLabels(const scene::Scene& scene, Overlay& overlay);

/// Adds the parallel coordinates of the rotated vertices along the bottom. If a density strip or the histogram of a
/// field is shown instead, adds only its axes and marks, and over a density strip the lines of the highlighted element;
/// CoordinatesPlot draws the rest. Does nothing if none of these is shown. If `onTop` is not null, adds these lines,
/// and what is drawn over them, as strokes to `onTop` instead; the caller must draw it when everything else is drawn.
/// Strokes can be drawn without OpenGL, which needs a fraction of the time for long lines.
void addCoordinates(const scene::Scene& scene, Overlay& overlay, ShapeBatch* onTop);

}  // namespace oval4d::render
