#pragma once

#include "export/drawing/drawing.hpp"
#include "geometry/rotation.hpp"
#include "scene/scene.hpp"
#include "slicing/object.hpp"

namespace oval4d::exports {

/// Draws the parallel coordinates of all rotated vertices: each vertex as lines or, for more than
/// scene::kMaxVerticesAsLines vertices, all of them as a density strip. Marks the vertices of the highlighted element
/// as pictures do: with bands behind their lines, or lines over the strip (see scene::forEachLineOverDensityStrip()).
/// For a field, draws the histogram of its values along x, y, z and w instead. `scene` must show `object` rotated by
/// `orientation`.
Drawing drawCoordinates(const scene::Scene& scene, const slicing::Object& object,
                        const geometry::Rotation& orientation);

}  // namespace oval4d::exports
