#pragma once
// Arranges the bodies of a file next to each other.

#include <vector>

#include "export/mesh/mesh.hpp"
#include "scene/scene.hpp"

namespace oval4d::exports {

/// The bodies of one slice, which are moved together: one body or, for a field, one body for each level; if the label
/// is separate, also the plate with the label, as the last body.
struct SliceBodies {
    int slice = 0;  ///< index in the slice set
    std::vector<PlacedMesh> bodies;
};

/// Moves the groups to places for a 3-D printer: on the plane z = 0, in rows from the origin in the directions +x and
/// +y, in the given order. The gaps between the bounding boxes of groups are size / 12, but at least 2 mm. `size` is
/// ExportRequest::size, in millimeters.
void arrangeOnPlate(std::vector<SliceBodies>& groups, double size, const RoundingGrid& grid);

/// Moves the groups to the positions that their slices have in `scene`. If groups might touch there, multiplies all
/// positions by a common factor that keeps the groups apart. `size` is ExportRequest::size, in millimeters.
void arrangeInOval(std::vector<SliceBodies>& groups, const scene::Scene& scene, double size, const RoundingGrid& grid);

/// Returns a generous estimate of the largest absolute coordinate, in millimeters, in a file with this number of
/// slices, which arrangeOnPlate() or arrangeInOval() has arranged. The step of the RoundingGrid depends on this
/// estimate. `size` is ExportRequest::size, in millimeters.
double coordinateBound(int slices, double size);

}  // namespace oval4d::exports
