#pragma once

#include "export/budget.hpp"
#include "export/drawing/drawing.hpp"
#include "scene/scene.hpp"
#include "slicing/object.hpp"

namespace oval4d::exports {

/// Draws the slices of a scene as its picture shows them: from the same camera, with the visible faces, bars, balls and
/// labels, and with the directions of the axes in the upper left corner. Bars are lines of constant width: the width at
/// the middle of the bar in the picture. The drawing has the aspect ratio of the scene's viewport.
///
/// Slices are drawn from far to near. The faces of a convex slice have two layers: first the faces turned away from the
/// viewer, then the faces turned toward the viewer. This order is exact. Faces that cross each other are divided into
/// pieces, which are drawn from far to near. Their order is not exact where they cross.
///
/// Throws ExportRefused if `object` is a field, because its surfaces are too fine for a drawing; if the drawing would
/// be too large; if the time limit is exceeded; or if a stop was requested.
Drawing drawSlices(const scene::Scene& scene, const slicing::Object& object, const ExportBudget& budget);

}  // namespace oval4d::exports
