#pragma once

#include "export/drawing/drawing.hpp"
#include "scene/scene.hpp"

namespace oval4d::exports {

/// Draws the projection of the whole object and the sections in it, as seen from the direction of the camera by a
/// parallel projection. Shapes are sorted by their depth; nearer bars are darker. The scene must show the projection.
Drawing drawProjection(const scene::Scene& scene);

}  // namespace oval4d::exports
