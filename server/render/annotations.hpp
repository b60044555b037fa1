#pragma once
// What stands beside the slices and explains them: axes, labels and the parallel coordinates.

#include "geometry/slice_set.hpp"
#include "render/overlay.hpp"
#include "render/solids.hpp"
#include "scene/scene.hpp"

namespace oval4d::render {

/// The x, y and z axes as the camera sees them, in the upper left corner, with their names.
void paintAxes(const scene::Scene& scene, Solids& solids, Overlay& overlay);

/// The w under each slice, from far to near; the focus last, on a plate.
void paintLabels(const scene::Scene& scene, Overlay& overlay);

/// The polytope's vertices as turned, along the bottom; of very many, the axes of their density strip.
void paintCoordinates(const geometry::SliceSet& slices, const scene::Scene& scene, Overlay& overlay);

}  // namespace oval4d::render
