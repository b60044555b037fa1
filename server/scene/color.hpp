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

/// Returns the color of cell type `type` with Coloring::cell_type, if there are `count` cell types.
Color cellTypeColor(std::size_t type, std::size_t count);

/// Computes the colors of an object's cells. Keeps everything that does not depend on the orientation for the next
/// call.
class CellColors {
  public:
    /// Writes one color per cell to `out`. The caller must pass `out` unchanged to the next call, because colors that
    /// stay the same are not written again. The same arguments always give the same colors. With Coloring::cell,
    /// neighboring cells differ in color; if there are more than 24 cells, those along one Hopf fiber share a color.
    /// With Coloring::w, the color depends on the w of the cell's center, divided by the greatest distance of any
    /// center from the origin: blue at −1, gray at 0, amber at 1.
    void paint(const slicing::Object& object, Coloring coloring, const geometry::Rotation& orientation,
               std::vector<Color>& out);

  private:
    std::uint64_t paintedFor_ = 0;  // the serial number of the object whose cells were last colored
    Coloring coloring_ = Coloring::cell;
    std::vector<glm::dvec4> centers_;  // of the cells, scaled so that the farthest one has length 1
};

}  // namespace oval4d::scene
