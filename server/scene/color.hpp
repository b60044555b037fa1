#pragma once
// The colors of cells.

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

/// The color of cell type `type` of `count` with Coloring::cell_type.
Color cellTypeColor(std::size_t type, std::size_t count);

/// Computes the colors of an object's cells. Caches between calls everything that does not depend on the orientation.
class CellColors {
  public:
    /// Writes one color per cell to `out`, which the caller passes unchanged to the next call. Equal arguments give
    /// equal colors. With Coloring::cell, neighboring cells differ in color; if there are more than 24 cells, those
    /// along one Hopf fiber share a hue. With Coloring::w, the color depends on the w of the cell's center relative to
    /// the greatest distance of any center from the origin: blue for −1, gray for 0, amber for 1.
    void paint(const slicing::Object& object, Coloring coloring, const geometry::Rotation& orientation,
               std::vector<Color>& out);

  private:
    std::uint64_t paintedFor_ = 0;  // the serial number of the object
    Coloring coloring_ = Coloring::cell;
    std::vector<glm::dvec4> centers_;  // of the cells, scaled so that the farthest one has length 1
};

}  // namespace oval4d::scene
