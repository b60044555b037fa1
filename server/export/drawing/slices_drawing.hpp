#pragma once

#include "export/budget.hpp"
#include "export/drawing/drawing.hpp"
#include "scene/scene.hpp"
#include "slicing/object.hpp"

namespace oval4d::exports {

/// Draws the slices of the scene as its picture shows them: from the same camera, with faces, bars, balls and labels as
/// far as they are shown, and the directions of the axes in the upper left corner. Bars are lines of constant width:
/// the width that the middle of the bar has in the picture. The drawing has the proportions of the scene's viewport.
///
/// Slices are drawn from far to near. The faces of a convex slice are drawn in two layers, first those turned away from
/// the viewer, then those turned toward the viewer. This order is exact. Faces that cross each other are divided into
/// pieces, which are drawn from far to near. The order of the pieces is not exact where they cross.
///
/// Throws ExportRefused if `object` is a field, whose surfaces are too fine for a drawing; if the drawing would be too
/// large; if the time limit is exceeded; or if a stop is requested.
Drawing drawSlices(const scene::Scene& scene, const slicing::Object& object, const Budget& budget);

}  // namespace oval4d::exports
