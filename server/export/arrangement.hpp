#pragma once
// Arranges the bodies of a file next to each other.

#include <vector>

#include "export/mesh/mesh.hpp"
#include "scene/scene.hpp"

namespace oval4d::exports {

/// The bodies of one slice, which are moved together: the body of the slice and, if it has a separate label, the plate.
struct SliceBodies {
    int slice = 0;  ///< index in the slice set
    std::vector<NamedMesh> solids;
};

/// Arranges groups for a 3-D printer: in rows on the plane z = 0, in the positive octant, in the given order. The gaps
/// between their bounding boxes are size / 12, but at least 2 mm. For `size`, see ExportRequest::size.
void arrangeOnPlate(std::vector<SliceBodies>& groups, double size, const Grid& grid);

/// Moves groups to the positions that their slices have in `scene`. If two slices would touch, enlarges the distances
/// between all slices by a common factor. For `size`, see ExportRequest::size.
void arrangeInOval(std::vector<SliceBodies>& groups, const scene::Scene& scene, double size, const Grid& grid);

/// Returns an upper bound of the absolute coordinates, in millimeters, in a file with this number of slices. The bound
/// holds for both arrangeOnPlate and arrangeInOval. For `size`, see ExportRequest::size.
double coordinateBound(int slices, double size);

}  // namespace oval4d::exports
