#pragma once
// Finds the point of a field's surfaces or contours that a picture shows at a pixel.

#include <cstddef>
#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "fields/field.hpp"
#include "geometry/rotation.hpp"
#include "scene/pick.hpp"
#include "scene/scene.hpp"

namespace oval4d::scene {

/// A point of a level set of a field that a picture shows. The point is on a surface in a slice, on the surface of the
/// focus slice (the middle one) in the projection, or on a contour in the matrix.
struct PickedLevel {
    std::size_t level = 0;  ///< the index of the level in slicing::FieldSettings::levels
    /// Whether the point is on a cap: where the boundary of the field's domain closes the body of the level.
    bool cap = false;
    PickLocation in = PickLocation::slice;  ///< where the point is: in a slice, the projection or the matrix
    std::size_t slice = 0;  ///< the index of the slice in the SliceSet; without meaning for PickLocation::matrix
    glm::dvec4 point{0};    ///< in the units of the object, after the rotation
};

/// Returns the point of a surface or contour that the picture shows at the pixel `point`: (x, y) from the upper left
/// corner. `field`, rotated by `orientation`, must be the object of `scene`. `element` is the result of pickElement()
/// for this pixel. Returns an empty optional if there is no such point, or if `element` is nearer to the viewer. Finds
/// the surface nearest to the viewer, even if this surface is translucent. What slices show counts as nearer than the
/// projection, over which they are drawn. `scene` must have the look of the surfaces and the contours, but needs no
/// slices.
///
/// In slices and in the projection, the search follows the ray through the pixel. It first evaluates the function at up
/// to kRaySamples points of the ray in the box. Their number is proportional to the length of the ray in the box, and
/// smaller if the function takes long to evaluate. Then it finds more and more exactly where the ray enters or leaves
/// the body of a level. It may miss bodies that are thinner along the ray than the distance of these points. Contours
/// are found up to 3 pixels from their lines. Throws std::runtime_error if the samples of the field are in a file that
/// can no longer be read.
std::optional<PickedLevel> pickLevel(const Scene& scene, const fields::Field& field,
                                     const geometry::Rotation& orientation, glm::dvec2 point,
                                     const std::optional<PickedElement>& element);

/// The greatest and the least number of points at which pickLevel() evaluates the function on a ray through one slice.
/// They apply if the ray's part in the box is as long as the diameter of the circumscribed sphere. Shorter parts have
/// proportionally fewer points.
inline constexpr double kRaySamples = 1000, kMinRaySamples = 200;

}  // namespace oval4d::scene
