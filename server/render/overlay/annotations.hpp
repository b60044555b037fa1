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

/// Where addCoordinates() adds strokes, which can be drawn without OpenGL: long lines and large areas then need a
/// fraction of the time. If a pointer is null, the overlay gets boxes and lines instead.
struct StrokeTargets {
    ShapeBatch* below = nullptr;  ///< drawn before the overlay
    ShapeBatch* above = nullptr;  ///< drawn when everything else is drawn
};

/// Adds the parallel coordinates of the rotated vertices along the bottom. If a density strip or the histogram of a
/// field is shown instead, adds only its axes and marks, and over a density strip the lines of the highlighted element;
/// CoordinatesPlot draws the rest. Does nothing if none of these is shown. Adds to `strokes` what marks the vertices of
/// the highlighted element: the bands behind their parallel coordinates, and the lines of zero behind the bands; or the
/// lines over a density strip, and the mark over these lines.
void addCoordinates(const scene::Scene& scene, Overlay& overlay, const StrokeTargets& strokes);

}  // namespace oval4d::render
