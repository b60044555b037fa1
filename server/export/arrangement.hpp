#pragma once
// Arranges the bodies of a file next to each other.

#include <vector>

#include "export/mesh/mesh.hpp"
#include "scene/scene.hpp"

namespace oval4d::exports {

/// The bodies of one slice, which are moved together: one body or, for a field, one for each level; then the plate of
/// the label if the label is separate.
struct SliceBodies {
    int slice = 0;  ///< index in the slice set
    std::vector<PlacedMesh> bodies;
};

/// Moves the groups to places for a 3-D printer: on the plane z = 0, in rows from the origin in the directions +x and
/// +y, in the given order. The gaps between their bounding boxes are size / 12, but at least 2 mm. `size` is
/// ExportRequest::size, in millimeters.
void arrangeOnPlate(std::vector<SliceBodies>& groups, double size, const RoundingGrid& grid);

/// Moves groups to the positions that their slices have in `scene`. If two slices would touch, enlarges the distances
/// between all slices by a common factor. `size` is ExportRequest::size, in millimeters.
void arrangeInOval(std::vector<SliceBodies>& groups, const scene::Scene& scene, double size, const RoundingGrid& grid);

/// Returns a generous estimate of the largest absolute coordinate, in millimeters, in a file with this number of
/// slices, for both arrangeOnPlate() and arrangeInOval(). Used to choose the step of the RoundingGrid. `size` is
/// ExportRequest::size, in millimeters.
double coordinateBound(int slices, double size);

}  // namespace oval4d::exports
