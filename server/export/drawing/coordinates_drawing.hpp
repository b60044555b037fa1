#pragma once

#include "export/drawing/drawing.hpp"
#include "geometry/rotation.hpp"
#include "scene/scene.hpp"
#include "slicing/object.hpp"

namespace oval4d::exports {

/// Draws the parallel coordinates of all rotated vertices: as lines or, for more than scene::kMaxVerticesAsLines
/// vertices, as a density strip. The vertices of the highlighted element are marked as in pictures: by bands behind
/// their lines, or by lines over the strip (see scene::forEachLineOverDensityStrip()). For a field, draws the histogram
/// of its values along x, y, z and w instead. `scene` must show `object` rotated by `orientation`.
Drawing drawCoordinates(const scene::Scene& scene, const slicing::Object& object,
                        const geometry::Rotation& orientation);

}  // namespace oval4d::exports
