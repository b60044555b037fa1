#pragma once
// Finds what a picture shows at a point.

#include <cstdint>
#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "scene/scene.hpp"
#include "slicing/element.hpp"

namespace oval4d::scene {

/// The part of a picture in which an element is found.
enum class PictureArea : std::uint8_t { slice, projection, coordinates, matrix };
inline constexpr auto kPictureAreas =
    std::to_array<text::Choice<PictureArea>>({{"slice", PictureArea::slice},
                                              {"projection", PictureArea::projection},
                                              {"coordinates", PictureArea::coordinates},
                                              {"matrix", PictureArea::matrix}});

/// An element that a picture shows at a point.
struct PickedElement {
    slicing::Element element;
    PictureArea area = PictureArea::slice;
    std::size_t slice = 0;  ///< PictureArea::slice: the index of the slice in SliceSet
};

/// Returns the element of `object` that is shown at the point (x, y), in pixels from the upper left corner, and is
/// nearest to the viewer: the vertex, edge, 2-face or cell to which a ball, bar or face belongs, or the vertex of a
/// column of the parallel coordinates, or the element that a panel of the matrix shows. Balls and bars are hit up to a
/// few pixels beyond their edges. Returns an empty optional if there is none. Takes time linear in the size of the
/// slices.
std::optional<PickedElement> pickElement(const Scene& scene, const slicing::Object& object, glm::dvec2 point);

/// Returns the point of the object's space, in its units, that a panel of the matrix shows at the point (x, y), in
/// pixels from the upper left corner; nothing outside the panels.
std::optional<glm::dvec4> matrixPointAt(const Scene& scene, glm::dvec2 point);

}  // namespace oval4d::scene
