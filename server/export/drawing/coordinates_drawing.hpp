#pragma once

#include "export/drawing/drawing.hpp"
#include "geometry/rotation.hpp"
#include "scene/scene.hpp"
#include "slicing/object.hpp"

namespace oval4d::exports {

/// Draws the parallel coordinates of all rotated vertices: as lines or, for more than scene::kMaxVerticesAsLines
/// vertices, as a density strip. For a field, draws the histogram of its values along x, y, z and w instead. `scene`
/// must show `object` rotated by `orientation`.
Drawing drawCoordinates(const scene::Scene& scene, const slicing::Object& object,
                        const geometry::Rotation& orientation);

}  // namespace oval4d::exports
