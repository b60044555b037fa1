#pragma once
// The colors of cells.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec4.hpp>

#include "geometry/rotation.hpp"
#include "scene/look.hpp"
#include "slicing/object.hpp"

namespace oval4d::scene {

/// An sRGB color: 0xRRGGBB.
using Color = std::uint32_t;

/// Returns the color that Coloring::cell_type gives to the cells of type `type`, if the object has `count` cell types.
Color cellTypeColor(std::size_t type, std::size_t count);

/// Computes the colors of an object's cells. Keeps everything that does not depend on the orientation for the next
/// call.
class CellColors {
  public:
    /// Writes one color per cell to `out`. The caller must pass `out` unchanged to the next call, because colors that
    /// stay the same are not written again. The same arguments always give the same colors. With Coloring::cell, up to
    /// 24 cells all have different colors; of more than 24, the cells along one Hopf fiber (a great circle) share a
    /// color. With Coloring::w, the color depends on the w of the cell's center after the rotation, divided by the
    /// greatest distance of any center from the origin: blue at −1, gray at 0, amber at 1. With Coloring::light, the
    /// lightness of a single hue depends on the angle between the cell's outward normal after the rotation and the
    /// direction toward a light in four dimensions.
    void paint(const slicing::Object& object, Coloring coloring, const geometry::Rotation& orientation,
               std::vector<Color>& out);

  private:
    void findCenters(const slicing::Object& object);
    void findNormals(const slicing::Object& object);
    void paintBy(const std::array<Color, 255>& scale, const glm::dvec4& axis, std::vector<Color>& out) const;

    std::uint64_t paintedFor_ = 0;  // the serial number of the object whose cells were last colored
    Coloring coloring_ = Coloring::cell;
    std::vector<glm::dvec4> directions_;  // per cell, before the rotation: for w and light, what determines its color
};

}  // namespace oval4d::scene
