#pragma once
// The layout of the parallel coordinates.

#include "scene/layout.hpp"

namespace oval4d::scene {

/// Lays out the parallel coordinates of an object in a picture with this aspect ratio (width / height). Overwrites
/// `out`.
void layOutCoordinates(const LayoutObjectInfo& content, double aspect, CoordinatesLayout& out);

}  // namespace oval4d::scene
