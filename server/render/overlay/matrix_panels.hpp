#pragma once

#include "render/overlay/overlay.hpp"
#include "scene/scene.hpp"

namespace oval4d::render {

/// Draws the matrix of planar sections; does nothing if the scene shows none. Edges have the colors of the cells from
/// which they were cut. Lines through the focus point show where the other planes meet each plane.
void paintMatrix(const scene::Scene& scene, Overlay& overlay);

}  // namespace oval4d::render
