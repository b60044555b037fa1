#pragma once
// Puts the projection of the whole object behind the slices. Renderers need this if they always let the nearer of two
// shapes hide the other one.

#include "scene/scene.hpp"

namespace oval4d::scene {

/// Returns the factor, at least 1, by which the projection of the whole object must be enlarged about the eye so that
/// it covers no slice. Such an enlargement does not change the image of the projection. But it puts the projection
/// behind all slices that the projection overlaps in the image. The factor is 1 if the projection overlaps no slice.
/// Parts of the projection that are nearer to the eye than Camera::near may still cover slices. The scene must show the
/// projection.
double enlargementBehindSlices(const Scene& scene);

}  // namespace oval4d::scene
