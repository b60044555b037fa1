#pragma once
// Arranges the bodies in an exported file next to each other.

#include <vector>

#include "export/mesh/mesh.hpp"
#include "scene/scene.hpp"

namespace oval4d::exports {

/// The bodies of one slice, which are moved together: one body or, for a field, one body for each level. If the label
/// is separate, the plate with the label is the last body.
struct SliceBodies {
    int slice = 0;  ///< index of the slice in the slice set
    std::vector<PlacedMesh> bodies;
};

/// Moves the groups to places for a 3-D printer: onto the plane z = 0, in rows along x, of which the first begins at
/// the origin and the others follow toward +y. Keeps the order of the groups. The gaps between the bounding boxes of
/// groups are size / 12, but at least 2 mm. `size` is ExportRequest::size, in millimeters.
void arrangeOnPlate(std::vector<SliceBodies>& groups, double size, const RoundingGrid& grid);

/// Moves the groups to the positions of their slices in `scene`. If groups might touch there, multiplies all positions
/// by one factor that keeps the groups apart. `size` is ExportRequest::size, in millimeters.
void arrangeInOval(std::vector<SliceBodies>& groups, const scene::Scene& scene, double size, const RoundingGrid& grid);

/// Returns an upper estimate, in millimeters, of the absolute coordinates in a file with `slices` slices,
/// after arrangeOnPlate() or arrangeInOval(). The step of the RoundingGrid depends on this estimate. `size` is
/// ExportRequest::size, in millimeters.
double coordinateBound(int slices, double size);

}  // namespace oval4d::exports
