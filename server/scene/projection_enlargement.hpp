#pragma once
// Puts the projection of the whole object behind the slices, for renderers that always let the nearer of two shapes
// hide the other one.

#include "scene/scene.hpp"

namespace oval4d::scene {

/// Returns the factor, at least 1, by which the projection must be enlarged about the eye so that the projection covers
/// no slice. Such an enlargement does not change the image of the projection, but puts the projection behind all slices
/// that it overlaps in the image. The factor is 1 if it overlaps none. Parts of the projection that are nearer to the
/// eye than Camera::near may still cover slices. The scene must show the projection.
double enlargementBehindSlices(const Scene& scene);

}  // namespace oval4d::scene
