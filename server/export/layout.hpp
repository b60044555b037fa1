#pragma once
// Arranges the bodies of a file next to each other.

#include <vector>

#include "export/mesh/mesh.hpp"
#include "scene/scene.hpp"

namespace oval4d::exports {

/// The bodies of one slice, which are moved together: the slice itself and, if there is one, its separate label.
struct Group {
    int slice = 0;  ///< index in the slice set
    std::vector<NamedMesh> solids;
};

/// Moves groups to where a 3-D printer needs them: in rows on the plane z = 0, in the positive octant, in the given
/// order. The gaps between their bounding boxes are size / 12, but at least 2 mm. `size`: ExportRequest::size.
void arrangeOnPlate(std::vector<Group>& groups, double size, const Grid& grid);

/// Moves groups to the positions that their slices have in `scene`. If two slices would touch, enlarges the distances
/// between all of them by a common factor. `size`: ExportRequest::size.
void arrangeInOval(std::vector<Group>& groups, const scene::Scene& scene, double size, const Grid& grid);

/// Returns an upper bound, in millimeters, on the coordinates of `slices` slices after either arrangement.
double coordinateBound(int slices, double size);

}  // namespace oval4d::exports
