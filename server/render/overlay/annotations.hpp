#pragma once
// Adds the annotations of a picture: axes, labels and parallel coordinates. The functions add shapes, boxes and texts
// to lists; the caller draws the lists.

#include "render/overlay/overlay.hpp"
#include "render/slices/shape_batch.hpp"
#include "scene/scene.hpp"

namespace oval4d::render {

/// Adds the symbol of the x, y and z axes, as the camera sees them, to `shapes`, and the names of the axes to
/// `overlay`. The place of the symbol is Scene::axes.
void addAxesSymbol(const scene::Scene& scene, ShapeBatch& shapes, Overlay& overlay);

/// Adds the labels of the slices to `overlay`. A label shows the value of w of its slice. The label of the focus slice
/// (the middle one) is highlighted, and is added after the others.
void addLabels(const scene::Scene& scene, Overlay& overlay);

/// The lists to which addCoordinatesOverlay() adds strokes. Strokes can be drawn without OpenGL, so long lines and
/// large areas need only a fraction of the time. If a pointer is null, the overlay gets boxes and lines instead of
/// strokes.
struct StrokeTargets {
    ShapeBatch* below = nullptr;  ///< the strokes that are drawn before the overlay
    ShapeBatch* above = nullptr;  ///< the strokes that are drawn after everything else
};

/// Adds the parallel coordinates of the rotated vertices along the lower edge of the picture. If a density strip or the
/// histogram of a field is shown instead, DensityStripOrHistogramPainter draws it; this function then adds only axes
/// and marks and, over a density strip, the lines of the highlighted element. Does nothing if the scene shows neither
/// lines nor a strip nor a histogram.
///
/// Adds to `strokes` what marks the vertices of the highlighted element. For parallel coordinates, these are the bands
/// behind the lines of the vertices, and the lines of zero behind the bands. Over a density strip, these are the lines
/// of the vertices, and the mark of the focus slice, which lies over these lines.
void addCoordinatesOverlay(const scene::Scene& scene, Overlay& overlay, const StrokeTargets& strokes);

}  // namespace oval4d::render
