#pragma once
// Finds the element of the object, or the point in space, that a picture shows at a pixel.

#include <cstdint>
#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "scene/scene.hpp"
#include "slicing/element.hpp"

namespace oval4d::scene {

/// The part of the picture in which something is picked: a slice, the projection, the parallel coordinates or the
/// matrix.
enum class PickLocation : std::uint8_t { slice, projection, coordinates, matrix };
inline constexpr auto kPickedIn =
    text::completeTable<text::NamedValue<PickLocation>>({{"slice", PickLocation::slice},
                                                         {"projection", PickLocation::projection},
                                                         {"coordinates", PickLocation::coordinates},
                                                         {"matrix", PickLocation::matrix}});

/// The element of the object that a picture shows at a pixel.
struct PickedElement {
    slicing::Element element;
    PickLocation in = PickLocation::slice;
    /// For PickLocation::slice: the index of the slice in the SliceSet. Otherwise without meaning.
    std::size_t slice = 0;
    /// In slices and in the projection: the distance of the element from the eye along the camera's axis, in world
    /// units.
    double depth = 0;
};

/// Returns the element of `object` that the picture shows at the pixel `point`: (x, y) from the upper left corner.
/// Returns an empty optional if there is none.
/// - In slices, the result is the element whose ball, bar or face is nearest to the viewer.
/// - Where the slices show no element, the result is the nearest element in the projection, over which the slices are
///   drawn.
/// - In the parallel coordinates, the result is the vertex whose lines are drawn there (see
///   ParallelCoordinatesLayout::hasLines()), or the vertex that vertexInDensityStripAt() finds.
/// - In a panel of the matrix, the result is the element from which the point or edge of the section was cut.
///
/// Balls and points are found at least up to 3 pixels from their centers, and bars and edges at least up to 3 pixels
/// from their axes, even if they are drawn thinner. Takes time linear in the size of the slices and in the number of
/// vertices.
std::optional<PickedElement> pickElement(const Scene& scene, const slicing::Object& object, glm::dvec2 point);

/// Returns the 4-D point that a panel of the matrix shows at the pixel `point`: (x, y) from the upper left corner.
/// Returns an empty optional outside the panels, on the diagonal, and if the scene shows no matrix. The result is in
/// the object's units and in the coordinates after the rotation, like SectionMatrix::point.
std::optional<glm::dvec4> matrixPointAt(const Scene& scene, glm::dvec2 point);

/// The distance, in pixels, within which pickElement() and pickLevel() find balls, bars, points, edges and contours,
/// even if these are drawn thinner.
inline constexpr double kHitRadius = 3;

/// Returns the direction, in view coordinates, of the ray from the eye through the pixel `point`: (x, y) from the upper
/// left corner. The z of the direction is −1.
glm::dvec3 viewRayThrough(const Scene& scene, glm::dvec2 point);

/// Returns whether slices are hidden at the pixel `point`: (x, y) from the upper left corner. Slices may be hidden in
/// the part of the picture that belongs to the parallel coordinates (see Scene::clearsCoordinatesArea()).
bool isClearedOfSlices(const Scene& scene, glm::dvec2 point);

}  // namespace oval4d::scene
