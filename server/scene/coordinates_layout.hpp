#pragma once
// Lays out the parallel coordinates of an object's vertices in a picture.

#include "scene/layout.hpp"

namespace oval4d::scene {

/// Lays out the parallel coordinates of an object in a picture with the aspect ratio `aspect` (width / height).
/// Overwrites `out`.
void layOutCoordinates(const LayoutObjectInfo& content, double aspect, ParallelCoordinatesLayout& out);

}  // namespace oval4d::scene
